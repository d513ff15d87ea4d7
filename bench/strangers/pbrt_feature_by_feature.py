#!/usr/bin/env python3
"""Renders one small pbrt scene for each feature by `lumirank reference`, the scene that Mitsuba's format has for the same by Mitsuba, and says where they differ.

    bench/strangers/pbrt_feature_by_feature.py OUT [NAME ...] [--program lumirank] [--paths 256]

pbrt itself comes in no package, so what its documentation says is written down here a second time, as Mitsuba's scenes. Printed: as by feature_by_feature.py. What differs for a reason stands in docs/decisions.md.

Needs from pip: mitsuba==3.9.1, numpy, pillow, OpenEXR; and LLVM's library for Mitsuba.
"""
import math

import compare_blocks
from feature_by_feature import DIM, RAW, ball, bitmap, bsdf, number, rendered_by_mitsuba, rgb, write_files
from feature_by_feature import scene as mitsuba_scene

# The panel and the sky of `scene`, in pbrt's words.
PANEL = 'AttributeBegin\nAreaLightSource "diffuse" "rgb L" [12 11 9]\nShape "trianglemesh" "point3 P" [0 2.5 0.3  1 2.5 0.3  1 2.5 1.3  0 2.5 1.3] "integer indices" [0 1 2 0 2 3]\nAttributeEnd\nLightSource "infinite" "rgb L" [.3 .35 .4]\n'
DIM_SKY = 'LightSource "infinite" "rgb L" [.1 .1 .1]\n'
FLOOR = 'Material "diffuse" "rgb reflectance" [.4 .5 .3]\n'
LOOK = "Scale -1 1 1\nLookAt 0.6 1.8 4  0 0.6 0  0 1 0\n"
BALL = 'AttributeBegin\nTranslate 0 0.7 0\nShape "sphere" "float radius" 0.7\nAttributeEnd\n'
GRAY = 'Material "diffuse" "rgb reflectance" [.5 .5 .5]\n'


def pbrt(material=GRAY, light=PANEL, shape=BALL, camera=LOOK + 'Camera "perspective" "float fov" [27.276]\n', film="", floor=FLOOR, textures="", integrator='"path"', depth=7):
    return (f'{camera}Film "rgb" "integer xresolution" 96 "integer yresolution" 64 "string filename" "x.exr" {film}\nPixelFilter "box" "float xradius" .5 "float yradius" .5\nIntegrator {integrator} "integer maxdepth" {depth}\n'
            f"WorldBegin\n{light}{textures}AttributeBegin\n{floor}"
            'Shape "trianglemesh" "point3 P" [-4 0 4  4 0 4  4 0 -4  -4 0 -4] "point2 uv" [0 0  1 0  1 1  0 1] "integer indices" [0 1 2 0 2 3]\nAttributeEnd\n'
            f"{material}{shape}")


def scene(*args, **more):
    """With lamps that are gray surfaces as well: without a BSDF Mitsuba's are black, and pbrt's are of the current material."""
    return mitsuba_scene(*args, **more).replace('<emitter type="area">', bsdf("diffuse") + '<emitter type="area">')


def texture(name, kind, inner, of="spectrum"):
    return f'Texture "{name}" "{of}" "{kind}" {inner}\n'


def lit(shape, scale="", light='"rgb L" [8 7 5]'):
    return f'AttributeBegin\nAreaLightSource "diffuse" {light} {scale}\n{shape}\nAttributeEnd\n' + DIM_SKY


def floor_with(inner="", extra=""):
    """A floor with a picture, whose v runs down in Mitsuba and up in pbrt."""
    return bsdf("diffuse", bitmap("reflectance", extra + f'<transform name="to_uv">{inner}<scale y="-1"/><translate y="1"/></transform>'))


def scenes():
    red = '"rgb reflectance" [.7 .3 .2]'
    diffuse_red = bsdf("diffuse", rgb("reflectance", ".7,.3,.2"))
    out = {"diffuse": (pbrt(f'Material "diffuse" {red}\n'), scene(diffuse_red))}
    k = [2 * math.sqrt(r) / math.sqrt(1 - r) for r in (0.9, 0.6, 0.3)]
    metal = rgb("eta", "1,1,1") + rgb("k", ",".join(f"{x:.6f}" for x in k))
    out["conductor-reflectance"] = (pbrt('Material "conductor" "rgb reflectance" [.9 .6 .3]\n'), scene(bsdf("conductor", metal)))
    out["conductor-rough"] = (pbrt('Material "conductor" "rgb reflectance" [.9 .6 .3] "float roughness" .09\n'), scene(bsdf("roughconductor", metal + number("alpha", 0.3) + '<string name="distribution" value="ggx"/>')))
    out["conductor-gold"] = (pbrt('Material "conductor" "spectrum eta" "metal-Au-eta" "spectrum k" "metal-Au-k"\n'), scene(bsdf("conductor", '<string name="material" value="Au"/>')))
    out["dielectric"] = (pbrt('Material "dielectric" "float eta" 1.5\n'), scene(bsdf("dielectric", number("int_ior", 1.5) + number("ext_ior", 1))))
    out["dielectric-rough"] = (pbrt('Material "dielectric" "float eta" 1.5 "float roughness" .2 "bool remaproughness" false\n'),
                               scene(bsdf("roughdielectric", number("int_ior", 1.5) + number("ext_ior", 1) + number("alpha", 0.2) + '<string name="distribution" value="ggx"/>')))
    out["thindielectric"] = (pbrt('Material "thindielectric" "float eta" 1.5\n'), scene(bsdf("thindielectric", number("int_ior", 1.5) + number("ext_ior", 1))))
    plastic = rgb("diffuse_reflectance", ".7,.3,.2") + number("int_ior", 1.5) + number("ext_ior", 1) + '<boolean name="nonlinear" value="true"/>'
    out["coateddiffuse"] = (pbrt(f'Material "coateddiffuse" {red} "float roughness" 0\n'), scene(bsdf("plastic", plastic)))
    out["coateddiffuse-rough"] = (pbrt(f'Material "coateddiffuse" {red} "float roughness" .04\n'), scene(bsdf("roughplastic", plastic + number("alpha", 0.2) + '<string name="distribution" value="ggx"/>')))
    out["mix"] = (pbrt(f'MakeNamedMaterial "a" "string type" "diffuse" {red}\nMakeNamedMaterial "b" "string type" "conductor" "rgb reflectance" [.9 .6 .3] "float roughness" .09\nMaterial "mix" "string materials" ["a" "b"] "float amount" .3\n'),
                  scene(bsdf("blendbsdf", number("weight", 0.3) + diffuse_red + bsdf("roughconductor", metal + number("alpha", 0.3) + '<string name="distribution" value="ggx"/>'))))
    out["alpha"] = (pbrt(f'Material "diffuse" {red}\n', shape=BALL.replace('"float radius" 0.7', '"float radius" 0.7 "float alpha" .4')), scene(bsdf("mask", number("opacity", 0.4) + bsdf("twosided", diffuse_red))))
    # Textures on the floor.
    image = texture("t", "imagemap", '"string filename" "colors.png"')
    use = 'Material "diffuse" "texture reflectance" "t"\n'
    out["imagemap"] = (pbrt(floor=use, textures=image), scene(floor=floor_with()))
    out["imagemap-scaled"] = (pbrt(floor=use, textures=texture("t", "imagemap", '"string filename" "colors.png" "float uscale" 3 "float vscale" 2 "float udelta" .25')),
                              scene(floor=floor_with('<scale x="3" y="2"/><translate x="0.25"/>')))
    out["imagemap-linear"] = (pbrt(floor=use, textures=texture("t", "imagemap", '"string filename" "colors.png" "string encoding" "linear"')), scene(floor=floor_with(extra=RAW)))
    half = texture("i", "imagemap", '"string filename" "colors.png"') + texture("t", "mix", '"texture tex1" "i" "rgb tex2" [0 0 0] "float amount" .5')
    out["texture-mix"] = (pbrt(floor=use, textures=half), scene(floor=bsdf("blendbsdf", number("weight", 0.5) + bsdf("diffuse", rgb("reflectance", "0")) + floor_with())))
    half = texture("i", "imagemap", '"string filename" "colors.png"') + texture("t", "scale", '"texture tex" "i" "float scale" .5')
    out["texture-scale"] = (pbrt(floor=use, textures=half), out["texture-mix"][1])
    out["checkerboard"] = (pbrt(floor=use, textures=texture("t", "checkerboard", '"rgb tex1" [.4 .4 .4] "rgb tex2" [.2 .2 .2] "float uscale" 10 "float vscale" 6')),
                           scene(floor=bsdf("diffuse", '<texture name="reflectance" type="checkerboard"><transform name="to_uv"><scale x="5" y="3"/></transform></texture>')))
    # Lights.
    out["point"] = (pbrt(light='LightSource "point" "rgb I" [6 5 4] "point3 from" [1 2 1]\n'), scene(light='<emitter type="point"><point name="position" x="1" y="2" z="1"/>' + rgb("intensity", "6,5,4") + "</emitter>"))
    out["point-scale"] = (pbrt(light='LightSource "point" "rgb I" [3 2.5 2] "float scale" 2 "point3 from" [1 2 1]\n'), out["point"][1])
    out["point-transformed"] = (pbrt(light='AttributeBegin\nTranslate 1 0 1\nLightSource "point" "rgb I" [6 5 4] "point3 from" [0 2 0]\nAttributeEnd\n'), out["point"][1])
    out["distant"] = (pbrt(light='LightSource "distant" "rgb L" [2 1.8 1.5] "point3 from" [.5 1 .4] "point3 to" [0 0 0]\n' + DIM_SKY), scene(light='<emitter type="directional"><vector name="direction" value="-0.5,-1,-0.4"/>' + rgb("irradiance", "2,1.8,1.5") + "</emitter>" + DIM))
    tri = 'Shape "trianglemesh" "point3 P" [0 2.5 0.3  1 2.5 0.3  1 2.5 1.3  0 2.5 1.3] "integer indices" [0 1 2 0 2 3]'
    back = 'Shape "trianglemesh" "point3 P" [0 2.5 0.3  1 2.5 0.3  1 2.5 1.3  0 2.5 1.3] "integer indices" [0 2 1 0 3 2]'
    panel = '<shape type="rectangle"><transform name="to_world"><scale value="0.5"/><rotate x="1" angle="90"/><translate x="0.5" y="2.5" z="0.8"/></transform><emitter type="area">' + rgb("radiance", "8,7,5") + "</emitter></shape>" + DIM
    out["area"] = (pbrt(light=lit(tri)), scene(light=panel))
    out["area-scale"] = (pbrt(light=lit(tri, '"float scale" 2', '"rgb L" [4 3.5 2.5]')), scene(light=panel))
    out["area-twosided"] = (pbrt(light=lit(back, '"bool twosided" true')), scene(light=panel))
    out["area-reversed"] = (pbrt(light=lit("ReverseOrientation\n" + back)), scene(light=panel))
    out["area-sphere"] = (pbrt(light=lit('Translate 1.2 1.2 1\nShape "sphere" "float radius" .25')), scene(light='<shape type="sphere"><point name="center" x="1.2" y="1.2" z="1"/><float name="radius" value="0.25"/><emitter type="area">' + rgb("radiance", "8,7,5") + "</emitter></shape>" + DIM))
    out["area-disk"] = (pbrt(light=lit('Translate 0 2.4 0\nRotate 90 1 0 0\nShape "disk" "float radius" .4')), scene(light='<shape type="disk"><transform name="to_world"><scale value="0.4"/><rotate x="1" angle="90"/><translate y="2.4"/></transform><emitter type="area">' + rgb("radiance", "8,7,5") + "</emitter></shape>" + DIM))
    # Shapes.
    two = bsdf("twosided", bsdf("diffuse", bitmap("reflectance")))
    painted = image + 'Material "diffuse" "texture reflectance" "t"\n'
    turned = "AttributeBegin\nTranslate 0 0.7 0\nRotate 50 1 0 0\nRotate 30 0 0 1\n"
    out["sphere-texture"] = (pbrt(painted, shape=turned + 'Shape "sphere" "float radius" 0.7\nAttributeEnd\n'),
                             scene(shape='<shape type="sphere"><transform name="to_world"><scale value="0.7"/><rotate z="1" angle="30"/><rotate x="1" angle="50"/><translate y="0.7"/></transform>' + two + "</shape>"))
    out["disk"] = (pbrt(GRAY, shape='AttributeBegin\nTranslate 0 0.9 0\nRotate -30 1 0 0\nShape "disk" "float radius" .9\nAttributeEnd\n'),
                   scene(shape='<shape type="disk"><transform name="to_world"><scale value="0.9"/><rotate x="1" angle="-30"/><translate y="0.9"/></transform>' + bsdf("twosided", bsdf("diffuse")) + "</shape>"))
    out["cylinder"] = (pbrt(GRAY, shape='AttributeBegin\nTranslate 0 0.7 0\nRotate 40 0 1 0\nShape "cylinder" "float radius" .3 "float zmin" -.8 "float zmax" .8\nAttributeEnd\n'),
                       scene(shape='<shape type="cylinder"><float name="radius" value="0.3"/><point name="p0" x="0" y="0" z="-.8"/><point name="p1" x="0" y="0" z=".8"/><transform name="to_world"><rotate y="1" angle="40"/><translate y="0.7"/></transform>' + bsdf("twosided", bsdf("diffuse")) + "</shape>"))
    out["plymesh"] = (pbrt(GRAY, shape='Shape "plymesh" "string filename" "wave.ply"\n'), scene(shape='<shape type="ply"><string name="filename" value="wave.ply"/>' + bsdf("twosided", bsdf("diffuse")) + "</shape>"))
    out["bilinearmesh"] = (pbrt(GRAY, shape='Shape "bilinearmesh" "point3 P" [-.8 .1 0  .8 .1 0  -.8 1.4 -.3  .8 1.4 -.3]\n'),
                           scene(shape='<shape type="rectangle"><transform name="to_world"><matrix value="0.8 0 0 0  0 0.65 0 0.75  0 -0.15 1 -0.15  0 0 0 1"/></transform>' + bsdf("twosided", bsdf("diffuse")) + "</shape>"))
    out["instances"] = (pbrt(GRAY, shape='ObjectBegin "w"\nShape "plymesh" "string filename" "wave.ply"\nObjectEnd\nAttributeBegin\nTranslate .7 0 0\nScale .4 .9 .5\nObjectInstance "w"\nAttributeEnd\n'),
                        scene(shape='<shape type="ply"><string name="filename" value="wave.ply"/><transform name="to_world"><scale x="0.4" y="0.9" z="0.5"/><translate x="0.7"/></transform>' + bsdf("twosided", bsdf("diffuse")) + "</shape>"))
    # Cameras and films.
    out["thinlens"] = (pbrt(camera=LOOK + 'Camera "perspective" "float fov" [27.276] "float lensradius" .15 "float focaldistance" 3.6\n'),
                       scene(kind="thinlens", camera=number("fov", 40) + number("aperture_radius", 0.15) + number("focus_distance", 3.6) + '<transform name="to_world"><lookat origin="0.6,1.8,4" target="0,0.6,0" up="0,1,0"/></transform>'))
    out["screenwindow"] = (pbrt(camera=LOOK + 'Camera "perspective" "float fov" [90] "float screenwindow" [-.36397 .36397 -.242647 .242647]\n'), scene())
    out["orthographic"] = (pbrt(camera=LOOK + 'Camera "orthographic" "float screenwindow" [-2 2 -1.33333 1.33333]\n'),
                           scene(kind="orthographic", camera='<transform name="to_world"><scale x="2" y="2"/><lookat origin="0.6,1.8,4" target="0,0.6,0" up="0,1,0"/></transform>'))
    out["iso"] = (pbrt(film='"float iso" 200', camera=LOOK + 'Camera "perspective" "float fov" [27.276] "float shutterclose" .5\n'), scene())
    fog = bsdf("null")
    inside = lambda inner: ball(fog).replace("</shape>", f'<medium name="interior" type="homogeneous">{inner}</medium></shape>')
    for name, words, xml in (("medium", '"rgb sigma_a" [.6 1.2 2.1] "rgb sigma_s" [2.4 1.8 .9]', rgb("albedo", ".8,.6,.3") + number("sigma_t", 3)),
                             ("medium-forward", '"rgb sigma_a" [.3 .3 .3] "rgb sigma_s" [1.2 1.2 1.2] "float scale" 2 "float g" .7', rgb("albedo", ".8") + number("sigma_t", 3) + '<phase type="hg"><float name="g" value="0.7"/></phase>')):
        out[name] = (pbrt(f'MakeNamedMedium "m" "string type" "homogeneous" {words}\nMediumInterface "m" ""\nMaterial "interface"\n', integrator='"volpath"', depth=23), scene(shape=inside(xml), integrator="volpath", depth=24))
    return out


def main():
    every = scenes()

    def write(out, name):
        write_files(out)
        (out / f"{name}.pbrt").write_text(every[name][0])
        (out / f"{name}.xml").write_text(every[name][1])
        return out / f"{name}.pbrt"

    compare_blocks.go_through(__doc__, every, write, rendered_by_mitsuba)


if __name__ == "__main__":
    main()
