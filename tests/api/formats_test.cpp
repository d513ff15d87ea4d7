// One scene in several formats renders to the same picture.
#include <gtest/gtest.h>

#include <cmath>

#include "support/same_pictures.h"
#include "support/scene_file.h"

namespace lumirank::test {
namespace {

// A checkered floor, a rough metal, a glass and a matt sphere under a lamp, a point light, a distant one and
// a sky. Nothing is symmetric, so that a mirrored or turned picture would differ.
const char* const kMitsuba = R"(
<integrator type="path"><integer name="max_depth" value="5"/></integrator>
<sensor type="perspective"><float name="fov" value="40"/><string name="fov_axis" value="smaller"/>
  <transform name="to_world"><lookat origin="1, 2, 6" target="0.2, 0.7, 0" up="0, 1, 0"/></transform>
  <film type="hdrfilm"><integer name="width" value="48"/><integer name="height" value="36"/><rfilter type="box"/></film>
</sensor>
<emitter type="constant"><rgb name="radiance" value="0.1, 0.15, 0.2"/></emitter>
<emitter type="point"><point name="position" x="-3" y="4" z="2"/><rgb name="intensity" value="6, 3, 2"/></emitter>
<emitter type="directional"><vector name="direction" x="-1" y="-2" z="-0.5"/><rgb name="irradiance" value="0.3, 0.3, 0.5"/></emitter>
<shape type="rectangle">
  <transform name="to_world"><rotate x="1" angle="-90"/><scale value="4"/></transform>
  <bsdf type="twosided"><bsdf type="diffuse"><texture type="checkerboard" name="reflectance">
    <rgb name="color0" value="0.8, 0.7, 0.3"/><rgb name="color1" value="0.1, 0.1, 0.4"/>
    <transform name="to_uv"><scale x="3" y="2"/></transform></texture></bsdf></bsdf>
</shape>
<shape type="rectangle">
  <transform name="to_world"><rotate x="1" angle="90"/><scale x="0.7" z="0.4"/><translate x="0.5" y="3"/></transform>
  <bsdf type="twosided"><bsdf type="diffuse"><rgb name="reflectance" value="0, 0, 0"/></bsdf></bsdf>
  <emitter type="area"><rgb name="radiance" value="9, 8, 6"/></emitter>
</shape>
<shape type="sphere"><point name="center" x="-1" y="0.8" z="0"/><float name="radius" value="0.8"/>
  <bsdf type="twosided"><bsdf type="roughconductor"><string name="distribution" value="ggx"/><float name="alpha" value="0.4"/>
    <rgb name="eta" value="0.2, 0.9, 1.1"/><rgb name="k" value="3.9, 2.4, 2.2"/></bsdf></bsdf></shape>
<shape type="sphere"><point name="center" x="0.8" y="0.6" z="0.9"/><float name="radius" value="0.6"/>
  <bsdf type="dielectric"><float name="int_ior" value="1.5"/><float name="ext_ior" value="1"/></bsdf></shape>
<shape type="sphere"><point name="center" x="1.3" y="0.5" z="-1"/><float name="radius" value="0.5"/>
  <bsdf type="twosided"><bsdf type="diffuse"><rgb name="reflectance" value="0.7, 0.1, 0.1"/></bsdf></bsdf></shape>
)";

const char* const kPbrt = R"(
Integrator "path" "integer maxdepth" 4
Scale -1 1 1
LookAt 1 2 6  0.2 0.7 0  0 1 0
Camera "perspective" "float fov" 40
Film "rgb" "integer xresolution" 48 "integer yresolution" 36
PixelFilter "box"
WorldBegin
LightSource "infinite" "rgb L" [ 0.1 0.15 0.2 ]
LightSource "point" "point3 from" [ -3 4 2 ] "rgb I" [ 3 1.5 1 ] "float scale" 2
LightSource "distant" "point3 from" [ 1 2 0.5 ] "point3 to" [ 0 0 0 ] "rgb L" [ 0.3 0.3 0.5 ]
Texture "tiles" "spectrum" "checkerboard" "float uscale" 6 "float vscale" 4
  "rgb tex1" [ 0.8 0.7 0.3 ] "rgb tex2" [ 0.1 0.1 0.4 ]
Material "diffuse" "texture reflectance" "tiles"
Shape "bilinearmesh" "point3 P" [ -4 0 4  4 0 4  -4 0 -4  4 0 -4 ]
AttributeBegin
  Translate 0.5 3 0
  AreaLightSource "diffuse" "rgb L" [ 9 8 6 ]
  Material "diffuse" "rgb reflectance" [ 0 0 0 ]
  Shape "trianglemesh" "point3 P" [ -0.7 0 -0.4  0.7 0 -0.4  0.7 0 0.4  -0.7 0 0.4 ] "integer indices" [ 0 1 2 0 2 3 ]
AttributeEnd
AttributeBegin
  Translate -1 0.8 0
  Material "conductor" "float roughness" 0.16 "rgb eta" [ 0.2 0.9 1.1 ] "rgb k" [ 3.9 2.4 2.2 ]
  Shape "sphere" "float radius" 0.8
AttributeEnd
AttributeBegin
  Translate 0.8 0.6 0.9
  Material "dielectric" "float eta" 1.5
  Shape "sphere" "float radius" 0.6
AttributeEnd
Translate 1.3 0.5 -1
Material "diffuse" "rgb reflectance" [ 0.7 0.1 0.1 ]
Shape "sphere" "float radius" 0.5
)";

Plane picture(const Scene& scene, std::uint64_t seed) {
  RenderSettings settings;
  settings.traced.rest = RestOfPaths::skip;
  settings.seed = seed;
  ReferenceSettings how;
  how.spp = 64;
  return reference(scene, settings, how).picture.planes.at(0);
}

TEST(Formats, MitsubaAndPbrtGiveTheSamePicture) {
  const TemporaryFolder folder;
  const std::string file = folder / "scene.pbrt";
  { std::ofstream(file) << kPbrt; }
  LoadOptions strict;
  strict.strict = true;  // nothing is replaced or left out
  const Plane mitsuba = picture(load_text(kMitsuba, strict), 1), pbrt = picture(Scene::load(file, strict), 2);
  // Tessellated spheres are the same on both sides.
  expect_same_pictures(mitsuba.rgb, pbrt.rgb, {.width = 48, .height = 36});
}

}  // namespace
}  // namespace lumirank::test
