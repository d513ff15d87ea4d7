#!/usr/bin/env python3
"""Renders one small scene for each feature of Mitsuba 3's format by `lumirank reference` and by Mitsuba, and says where they differ.

    bench/strangers/feature_by_feature.py OUT [NAME ...] [--program lumirank] [--paths 256]

A ball on a floor, each time with another BSDF, texture, light, shape, camera, film or medium. Printed: the ratio of the means of the channels, and the least and greatest difference of blocks of 8×8 pixels, relative to Mitsuba's. Lines end in
<<< where a block is off by more than 6 % or a channel by more than 1.2 %; caustics are that noisy. What differs for a reason stands in docs/decisions.md ("What a file looks like is asked feature by feature").

Needs from pip: mitsuba==3.9.1, numpy, pillow, OpenEXR; and LLVM's library for Mitsuba.
"""
import math

import mitsuba
import numpy as np
import OpenEXR
from PIL import Image

import compare_blocks

mitsuba.set_variant("llvm_ad_rgb")

RAW = '<boolean name="raw" value="true"/>'
LOOK = '<transform name="to_world"><lookat origin="0.6,1.8,4" target="0,0.6,0" up="0,1,0"/></transform>'
DIM = '<emitter type="constant"><rgb name="radiance" value="0.1"/></emitter>'
PANEL = ('<emitter type="constant"><rgb name="radiance" value="0.3,0.35,0.4"/></emitter><shape type="rectangle"><transform name="to_world"><scale value="0.5"/>'
         '<rotate x="1" angle="90"/><translate x="0.5" y="2.5" z="0.8"/></transform><emitter type="area"><rgb name="radiance" value="12,11,9"/></emitter></shape>')


def rgb(name, value):
    return f'<rgb name="{name}" value="{value}"/>'


def number(name, value):
    return f'<float name="{name}" value="{value}"/>'


def text(name, value):
    return f'<string name="{name}" value="{value}"/>'


def bsdf(kind, inner=""):
    return f'<bsdf type="{kind}">{inner}</bsdf>'


def bitmap(name, extra="", file="colors.png"):
    return f'<texture name="{name}" type="bitmap"><string name="filename" value="{file}"/>{extra}</texture>'


def ball(inner, extra=""):
    return f'<shape type="sphere"><point name="center" x="0" y="0.7" z="0"/><float name="radius" value="0.7"/>{extra}{inner}</shape>'


def mesh(inner, kind="ply", file="wave.ply", extra=""):
    return f'<shape type="{kind}"><string name="filename" value="{file}"/>{extra}{inner}</shape>'


def lit(kind, transform, inner=rgb("radiance", "8,7,5")):
    return f'<shape type="{kind}">{transform}<emitter type="area">{inner}</emitter></shape>' + DIM


def scene(of_ball=bsdf("diffuse"), light=PANEL, shape="", camera=number("fov", 40) + LOOK, kind="perspective", film='<rfilter type="box"/>',
          floor=bsdf("diffuse", rgb("reflectance", "0.4,0.5,0.3")), integrator="path", depth=8):
    return (f'<scene version="3.0.0"><integrator type="{integrator}"><integer name="max_depth" value="{depth}"/></integrator>\n<sensor type="{kind}">{camera}<film type="hdrfilm"><integer name="width" value="96"/>'
            f'<integer name="height" value="64"/>{film}</film></sensor>\n<shape type="rectangle"><transform name="to_world"><rotate x="1" angle="-90"/><scale value="4"/></transform>{floor}</shape>\n'
            f"{shape or ball(of_ball)}{light}</scene>\n")


def medium(inner, boundary=bsdf("null")):
    return scene(shape=ball(boundary).replace("</shape>", f'<medium name="interior" type="homogeneous">{inner}</medium></shape>'), integrator="volpath", depth=24)


def sunsky(elevation, turbidity=3, extra=""):
    a = math.radians(elevation)
    return (f'<emitter type="sunsky">{number("turbidity", turbidity)}<vector name="sun_direction" value="{0.6 * math.cos(a)}, {math.sin(a)}, {0.8 * math.cos(a)}"/>{extra}'
            '<transform name="to_world"><rotate x="1" angle="-90"/></transform></emitter>')


def rendered_by_mitsuba(out, name, samples):
    return np.array(mitsuba.render(mitsuba.load_file(str(out / f"{name}.xml")), spp=samples), dtype=np.float64)[..., :3]


def write_files(out):
    rng = np.random.default_rng(1)
    Image.fromarray((rng.random((16, 16, 3)) * 255).astype(np.uint8)).save(out / "colors.png")
    Image.fromarray((np.kron(rng.random((4, 4)), np.ones((4, 4))) * 255).astype(np.uint8)).save(out / "gray.png")
    sky = np.full((32, 64, 3), 0.4, np.float32)
    sky[16:], sky[6:9, 20:24], sky[10:13, 50:60] = 0.1, (30, 28, 20), (1, 4, 9)
    OpenEXR.File({"compression": OpenEXR.ZIP_COMPRESSION, "type": OpenEXR.scanlineimage}, {"RGB": sky}).write(str(out / "sky.exr"))
    n = 24
    corners = [(2 * i / n - 1, 0.6 + 0.3 * math.sin(8 * i / n - 4) * math.cos(6 * j / n - 3), 2 * j / n - 1, i / n, j / n) for j in range(n + 1) for i in range(n + 1)]
    faces = [f for j in range(n) for i in range(n) for a in [j * (n + 1) + i] for f in ((a, a + n + 1, a + n + 2), (a, a + n + 2, a + 1))]
    header = f"ply\nformat ascii 1.0\nelement vertex {len(corners)}\n" + "".join(f"property float {p}\n" for p in "xyzuv") + f"element face {len(faces)}\nproperty list uchar int vertex_indices\nend_header\n"
    (out / "wave.ply").write_text(header + "".join(" ".join(f"{x:g}" for x in c) + "\n" for c in corners) + "".join("3 " + " ".join(map(str, f)) + "\n" for f in faces))
    (out / "wave.obj").write_text("".join(f"v {c[0]:g} {c[1]:g} {c[2]:g}\nvt {c[3]:g} {c[4]:g}\n" for c in corners) + "".join("f " + " ".join(f"{k + 1}/{k + 1}" for k in f) + "\n" for f in faces))


def scenes():
    red, two = rgb("base_color", ".7,.3,.2"), bsdf("twosided", bsdf("diffuse", bitmap("reflectance")))
    all_ = {"texture": scene(bsdf("diffuse", bitmap("reflectance"))), "raw": scene(bsdf("diffuse", bitmap("reflectance", RAW)))}
    for name, inner in {"nearest": text("filter_type", "nearest"), "mirror": text("wrap_mode", "mirror"), "clamp": text("wrap_mode", "clamp")}.items():
        all_["floor-" + name] = scene(floor=bsdf("diffuse", bitmap("reflectance", inner + '<transform name="to_uv"><scale x="3" y="2"/><rotate z="1" angle="20"/><translate x="-0.5"/></transform>')))
    all_["checkerboard"] = scene(floor=bsdf("diffuse", '<texture name="reflectance" type="checkerboard"><transform name="to_uv"><scale x="5" y="3"/></transform></texture>'))
    for kind in ("roughconductor", "roughdielectric"):
        for distribution in ("ggx", "beckmann"):
            for alpha in (0.05, 0.3):
                all_[f"{kind}-{distribution}-{alpha}"] = scene(bsdf(kind, number("alpha", alpha) + text("distribution", distribution)))
    for metal in ("Ag", "Al", "Au", "Cr", "Cu", "Hg", "Ir", "K", "Li", "TiN", "W"):
        all_["metal-" + metal] = scene(bsdf("conductor", text("material", metal)))
    all_["brushed"] = scene(bsdf("roughconductor", number("alpha_u", 0.05) + number("alpha_v", 0.4) + text("material", "Al")))
    for kind, inner in {"dielectric": number("int_ior", 1.5), "thindielectric": rgb("specular_transmittance", ".9,.5,.3"), "plastic": rgb("diffuse_reflectance", ".7,.3,.2"),
                        "roughplastic": rgb("diffuse_reflectance", ".7,.3,.2") + number("alpha", 0.2)}.items():
        all_[kind] = scene(bsdf(kind, inner))
    for name, inner in {"base": "", "metal": number("metallic", 0.9) + number("roughness", 0.2), "coat": number("clearcoat", 1) + number("clearcoat_gloss", 0.8), "sheen": number("sheen", 1) + number("sheen_tint", 0.5),
                        "glass": number("spec_trans", 0.8) + number("roughness", 0.2) + number("eta", 1.5), "anisotropic": number("anisotropic", 0.8) + number("metallic", 1), "flat": number("flatness", 0.7)}.items():
        all_["principled-" + name] = scene(bsdf("principled", red + inner))
    all_["principledthin"] = scene(bsdf("principledthin", red + number("spec_trans", 0.5) + number("diff_trans", 0.8) + number("eta", 1.4)))
    all_["blend"] = scene(bsdf("blendbsdf", number("weight", 0.3) + bsdf("diffuse") + bsdf("roughconductor", number("alpha", 0.3))))
    all_["mask"] = scene(bsdf("mask", number("opacity", 0.4) + bsdf("diffuse")))
    all_["hidden-emitters"] = scene(light=PANEL).replace('<integer name="max_depth" value="8"/>', '<integer name="max_depth" value="8"/><boolean name="hide_emitters" value="true"/>')
    all_["bumps"] = scene(floor=bsdf("bumpmap", bitmap("arbitrary", RAW + '<transform name="to_uv"><scale value="4"/></transform>') + number("scale", 0.03) + bsdf("roughconductor", number("alpha", 0.2))))
    light = {
        "point": '<emitter type="point"><point name="position" x="1" y="2" z="1"/>' + rgb("intensity", "6,5,4") + "</emitter>",
        "spot": '<emitter type="spot"><transform name="to_world"><lookat origin="1,3,1" target="0,0.3,0" up="0,0,1"/></transform>' + rgb("intensity", "20,18,12") + number("cutoff_angle", 30) + number("beam_width", 12) + "</emitter>",
        "directional": '<emitter type="directional"><vector name="direction" value="-0.5,-1,-0.4"/>' + rgb("irradiance", "2,1.8,1.5") + "</emitter>" + DIM,
        "envmap": '<emitter type="envmap"><string name="filename" value="sky.exr"/><transform name="to_world"><rotate y="1" angle="40"/></transform></emitter>',
        "area-texture": lit("rectangle", '<transform name="to_world"><rotate x="1" angle="70"/><translate y="2" z="-1.5"/></transform>', bitmap("radiance")),
        "area-sphere": lit("sphere", '<point name="center" x="1.2" y="1.2" z="1"/><float name="radius" value="0.25"/>'),
        "area-disk": lit("disk", '<transform name="to_world"><scale value="0.4"/><rotate x="1" angle="90"/><translate y="2.4"/></transform>'),
        "area-cube": lit("cube", '<transform name="to_world"><scale value="0.2"/><rotate y="1" angle="30"/><translate x="1" y="1.6"/></transform>'),
        "sky-high": sunsky(65), "sky-low": sunsky(12), "sky-haze": sunsky(40, 7), "sky-ground": sunsky(40, 3, rgb("albedo", "0.1,0.5,0.9")), "sun": sunsky(25, 2, number("sky_scale", 0)),
    }
    all_.update({name: scene(light=xml) for name, xml in light.items()})
    shape = {
        "cube": '<shape type="cube"><transform name="to_world"><scale value="0.6"/><rotate y="1" angle="30"/><translate y="0.6"/></transform>' + two + "</shape>",
        "cylinder": '<shape type="cylinder"><point name="p0" x="-.8" y="0.2" z="0"/><point name="p1" x="0.9" y="1.2" z="0.3"/><float name="radius" value="0.3"/>' + two + "</shape>",
        "disk": '<shape type="disk"><transform name="to_world"><scale value="0.9"/><rotate x="1" angle="-30"/><translate y="0.9"/></transform>' + two + "</shape>",
        "sphere": '<shape type="sphere"><transform name="to_world"><scale value="0.7"/><rotate z="1" angle="30"/><rotate x="1" angle="50"/><translate y="0.7"/></transform>' + two + "</shape>",
        "ply": mesh(two), "obj": mesh(two, "obj", "wave.obj"), "face-normals": mesh(bsdf("twosided", bsdf("plastic")), extra='<boolean name="face_normals" value="true"/>'), "one-sided": mesh(bsdf("diffuse")),
        "instances": '<shape type="shapegroup" id="g">' + mesh(two) + '</shape><shape type="instance"><ref id="g"/><transform name="to_world"><scale x="0.4" y="0.9" z="0.5"/><translate x="0.7"/></transform></shape>',
    }
    all_.update({name: scene(shape=xml) for name, xml in shape.items()})
    camera = {"fov-y": number("fov", 30) + text("fov_axis", "y"), "diagonal": number("fov", 40) + text("fov_axis", "diagonal"), "focal": text("focal_length", "35mm"),
              "principal-point": number("fov", 40) + number("principal_point_offset_x", 0.2) + number("principal_point_offset_y", -0.1), "clips": number("fov", 40) + number("near_clip", 3.6) + number("far_clip", 4.6)}
    all_.update({name: scene(camera=xml + LOOK) for name, xml in camera.items()})
    all_["thinlens"] = scene(kind="thinlens", camera=number("fov", 40) + number("aperture_radius", 0.15) + number("focus_distance", 3.6) + LOOK)
    all_["orthographic"] = scene(kind="orthographic", camera='<transform name="to_world"><scale x="2" y="2"/><lookat origin="0.6,1.8,4" target="0,0.6,0" up="0,1,0"/></transform>')
    for name in ("gaussian", "tent", "mitchell"):
        all_["filter-" + name] = scene(bsdf("diffuse", bitmap("reflectance")), film=f'<rfilter type="{name}"/>')
    for name, inner in {"isotropic": rgb("albedo", ".8,.6,.3") + number("sigma_t", 3), "forward": rgb("albedo", ".8") + number("sigma_t", 3) + '<phase type="hg"><float name="g" value="0.7"/></phase>',
                        "absorbing": rgb("albedo", "0") + rgb("sigma_t", ".2,.5,.9") + number("scale", 2), "by-color": rgb("albedo", ".9") + rgb("sigma_t", ".2,.5,.9") + number("scale", 5)}.items():
        all_["medium-" + name] = medium(inner)
    return all_


def main():
    every = scenes()

    def write(out, name):
        write_files(out)
        (out / f"{name}.xml").write_text(every[name])
        return out / f"{name}.xml"

    compare_blocks.go_through(__doc__, every, write, rendered_by_mitsuba)


if __name__ == "__main__":
    main()
