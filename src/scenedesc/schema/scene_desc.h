// What a scene file says, after parsing and before anything is built: plain values, printable, rewritable,
// and the same for every file format. Names are resolved to indices; files are named (absolute paths) but not
// opened, except that a reader may check that they exist.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "base/error.h"
#include "base/photometry.h"
#include "base/rgb.h"
#include "base/transform.h"
#include "base/vec.h"
#include "scenedesc/schema/mesh.h"

namespace lumirank::scenedesc {

inline constexpr int kNone = -1;  // "no index"

// ----------------------------------------------------------------------------------------------------
// textures

// 2×3 affine map from mesh uv to texture uv.
struct UvTransform {
  float m[6] = {1, 0, 0, 0, 1, 0};
  friend bool operator==(const UvTransform&, const UvTransform&) = default;
};

// A constant or a texture (an index into SceneDesc::textures), linear RGB.
struct ColorInput {
  Rgb value{0};
  int texture = kNone;
};
struct FloatInput {
  float value = 0;
  int texture = kNone;
};

enum class FilterMode { nearest, bilinear };
enum class WrapMode { repeat, mirror, clamp };
// `scalar`: what float parameters read of pictures in pbrt: the alpha channel if there is one that is not 1
// everywhere, else the mean of the channels.
enum class TextureChannel { rgb, red, green, blue, alpha, scalar };

// Texture coordinates: (u, v) = (0, 0) is the lower left corner of the picture, so v runs up and row 0 of the
// file is at v = 1. `to_uv` maps the surface's coordinates to these. Formats whose v runs down (Mitsuba: v =
// 0 is the top row) have that flip at the end of each bitmap's `to_uv`, after the format's own uv transform;
// surfaces, built-in shapes and meshes alike, keep the coordinates of their format
// (MeshFileDesc::flip_tex_coords). So wraps, scales, checkerboards and the uv of rectangles and spheres stay
// exact.
struct BitmapTextureDesc {
  std::string filename;
  // A PNG or JPEG file that the scene file holds; then `filename` only names it, in messages.
  std::shared_ptr<const std::string> bytes = nullptr;
  // There is no such file, and that was allowed: the world shows a stand-in (see --allow-missing).
  bool missing = false;
  // true: values are used as they are; false: an 8-bit file is decoded from sRGB (float files are linear
  // anyway).
  bool raw = false;
  TextureChannel channel = TextureChannel::rgb;  // another: that one alone, as grey (cut-outs by alpha)
  bool alpha_may_lack = false;                   // an alpha channel that the file does not have is 1
  FilterMode filter = FilterMode::bilinear;
  WrapMode wrap_u = WrapMode::repeat, wrap_v = WrapMode::repeat;
  UvTransform to_uv;
};
struct CheckerboardTextureDesc {
  ColorInput color0{Rgb(0.4f)}, color1{Rgb(0.2f)};
  UvTransform to_uv;
};
struct ScaleTextureDesc {
  ColorInput input;
  Rgb scale{1};
};
struct ProductTextureDesc {  // of two inputs, channel by channel: vertex colours and a texture, say
  ColorInput a{Rgb(1)}, b{Rgb(1)};
};
struct MixTextureDesc {  // (1 - amount) · a + amount · b, channel by channel
  ColorInput a{Rgb(0)}, b{Rgb(1)}, amount{Rgb(0.5f)};
};
struct RootTextureDesc {  // the square root, channel by channel: pbrt's widths of microfacets
  ColorInput input;
};
struct ThresholdTextureDesc {  // 1 where the input is at least the threshold, else 0: cut-outs with hard
                               // edges
  ColorInput input;
  float threshold = 0.5f;
};
struct VertexColorTextureDesc {
  std::string attribute = "vertex_color";
};
struct TextureDesc {
  std::string id;
  SourceLocation where;
  std::variant<BitmapTextureDesc, CheckerboardTextureDesc, ScaleTextureDesc, ProductTextureDesc,
               MixTextureDesc, RootTextureDesc, ThresholdTextureDesc, VertexColorTextureDesc>
      kind;
};

// -------------------------------------------------------------------------------------------------------
// BSDFs

enum class Distribution { beckmann, ggx };

struct NullBsdfDesc {};
struct DiffuseDesc {
  ColorInput reflectance{Rgb(0.5f)};
};
struct RoughDiffuseDesc {  // Oren-Nayar, alpha as in Mitsuba (σ = alpha/√2)
  ColorInput reflectance{Rgb(0.5f)};
  FloatInput alpha{0.2f};
};
struct ConductorDesc {  // smooth if alpha_u and alpha_v are the constant 0
  Rgb eta{0}, k{1};     // relative to the outside medium
  ColorInput specular_reflectance{Rgb(1)};
  Distribution distribution = Distribution::beckmann;
  FloatInput alpha_u{0}, alpha_v{0};
};
struct DielectricDesc {             // smooth if alpha_u and alpha_v are the constant 0
  float eta = 1.5046f / 1.000277f;  // interior index over exterior index
  ColorInput specular_reflectance{Rgb(1)}, specular_transmittance{Rgb(1)};
  Distribution distribution = Distribution::beckmann;
  FloatInput alpha_u{0}, alpha_v{0};
};
struct ThinDielectricDesc {
  float eta = 1.5046f / 1.000277f;
  ColorInput specular_reflectance{Rgb(1)}, specular_transmittance{Rgb(1)};
};
struct PlasticDesc {  // smooth coating if alpha is the constant 0
  float eta = 1.49f / 1.000277f;
  ColorInput diffuse_reflectance{Rgb(0.5f)}, specular_reflectance{Rgb(1)};
  bool nonlinear = false;
  Distribution distribution = Distribution::beckmann;
  FloatInput alpha{0};
  // The base gets all that the layer does not reflect (a colour of 1 loses nothing, whatever the roughness);
  // otherwise what single scattering by a rough interface lets through: much less, if it is rough. glTF;
  // overrides nonlinear.
  bool lossless = false;
};
struct PhongDesc {  // the modified (energy-conserving) Phong model
  ColorInput diffuse_reflectance{Rgb(0.5f)}, specular_reflectance{Rgb(0.2f)};
  FloatInput exponent{30};
};
struct WardDesc {
  enum class Variant { ward, ward_duer, balanced };
  Variant variant = Variant::balanced;
  ColorInput diffuse_reflectance{Rgb(0.5f)}, specular_reflectance{Rgb(0.2f)};
  FloatInput alpha_u{0.1f}, alpha_v{0.1f};
};
struct PrincipledDesc {  // Mitsuba 3's "principled"
  ColorInput base_color{Rgb(0.5f)};
  FloatInput roughness{0.5f}, anisotropic{0}, metallic{0}, spec_trans{0}, spec_tint{0}, sheen{0},
      sheen_tint{0}, clearcoat{0}, clearcoat_gloss{0}, flatness{0};
  float eta = 1.5f;
};
struct HairDesc {  // Kajiya-Kay; only for curves. Shares of the light that meets a fibre
  ColorInput diffuse_reflectance{Rgb(0.4f)}, specular_reflectance{Rgb(0.1f)};
  FloatInput exponent{40};  // the specular lobe falls like cosⁿ of the angle to the mirror cone
};
struct PrincipledThinDesc {  // Mitsuba 3's "principledthin": a sheet without thickness, alike on both sides
  ColorInput base_color{Rgb(0.5f)};
  FloatInput roughness{0.5f}, anisotropic{0}, spec_trans{0}, spec_tint{0}, sheen{0}, sheen_tint{0},
      flatness{0}, diff_trans{0};  // diff_trans: 0 to 2, all of the matt light goes through
  float eta = 1.5f;
};
// A thin sheet that reflects and lets through diffusely, alike on both sides: Mitsuba 0.6's "difftrans",
// pbrt's diffusetransmission. If both together exceed 1, they are scaled down alike.
struct DiffuseTransmitterDesc {
  ColorInput reflectance{Rgb(0)}, transmittance{Rgb(0.5f)};
};
// A dielectric layer over the nested BSDF, without scattering in it; smooth if alpha_u and alpha_v are the
// constant 0. Mitsuba 0.6's "coating" and "roughcoating", pbrt's coateddiffuse and coatedconductor (over a
// diffuse or conductor BSDF whose eta and k are relative to the layer), glTF's clear coat (`weight`).
struct CoatingDesc {
  int nested = kNone;
  float eta = 1.5046f / 1.000277f;          // index of the layer over that of the outside
  ColorInput specular_reflectance{Rgb(1)};  // scales the layer's own reflection alone
  ColorInput absorption{Rgb(0)};            // absorption coefficient × thickness, per channel, ≥ 0
  FloatInput weight{1};                     // share of the surface that is coated
  Distribution distribution = Distribution::beckmann;
  FloatInput alpha_u{0}, alpha_v{0};
};
// Sheen of cloth over the nested BSDF, which is dimmed by what the sheen reflects: glTF's
// KHR_materials_sheen.
struct SheenDesc {
  int nested = kNone;
  ColorInput color{Rgb(0)};
  FloatInput roughness{0};  // the square root of α
};
struct MaskDesc {  // opacity 1: the nested BSDF; 0: nothing there
  FloatInput opacity{0.5f};
  int nested = kNone;
};
struct TwoSidedDesc {
  int front = kNone, back = kNone;  // equal if one BSDF serves both
};
struct BumpMapDesc {
  int texture = kNone;  // displacement height, in world units per unit of uv
  float scale = 1;
  int nested = kNone;
};
struct NormalMapDesc {
  int texture = kNone;  // raw RGB, n = 2·rgb - 1 in the tangent frame
  int nested = kNone;
  float scale = 1;  // of n's first two components
  // The second axis points up in the picture, so against rising v, also where the uvs are mirrored (glTF);
  // otherwise it is n × dp/du (Mitsuba).
  bool follow_uv = false;
};
struct MixtureDesc {  // Σ weight_k · bsdf_k; "blendbsdf" has two entries and weights 1 - w, w
  struct Part {
    FloatInput weight;
    bool complement = false;  // the weight is 1 - value
    int bsdf = kNone;
  };
  std::vector<Part> parts;
};

struct BsdfDesc {
  std::string id;
  SourceLocation where;
  std::variant<DiffuseDesc, NullBsdfDesc, RoughDiffuseDesc, ConductorDesc, DielectricDesc, ThinDielectricDesc,
               PlasticDesc, PhongDesc, WardDesc, PrincipledDesc, PrincipledThinDesc, DiffuseTransmitterDesc,
               CoatingDesc, SheenDesc, HairDesc, MaskDesc, TwoSidedDesc, BumpMapDesc, NormalMapDesc,
               MixtureDesc>
      kind;
};

// ------------------------------------------------------------------------------------------------------
// shapes

enum class MeshFormat { obj, ply, serialized };

struct MeshFileDesc {
  MeshFormat format = MeshFormat::obj;
  std::string filename;
  int shape_index = 0;        // serialized only
  bool face_normals = false;  // ignore the file's normals
  // v → 1 - v of what the mesh file states, in place of the stated value. Mitsuba, 0.6 and 3.x alike: true by
  // default for OBJ (whose v runs up), false for PLY and serialized; the bitmap's own flip (see
  // BitmapTextureDesc) comes on top.
  bool flip_tex_coords = false;
  std::optional<float> max_smooth_angle;  // degrees; normals are made anew
  bool smooth_without_normals = true;     // false: a file without normals has face normals (pbrt)
};
// A mesh that the reader already holds: checked (see check_mesh) and never changed again. Shapes that share
// it share its geometry. Null: its file does not exist, and that was allowed (--allow-missing); like a mesh
// without a triangle it is left out, and counted, when the world is built.
struct InlineMeshDesc {
  std::shared_ptr<const MeshData> mesh;
  std::string name;  // for messages and listings
};
struct RectangleDesc {};  // [-1,1]² in z = 0, normal +z
struct CubeDesc {};       // [-1,1]³
struct SphereDesc {
  Vec3d center;
  float radius = 1;
};
struct DiskDesc {};  // unit disk in z = 0, normal +z
struct CylinderDesc {
  Vec3d p0{0, 0, 0}, p1{0, 0, 1};
  float radius = 1;
};
// Fibres: many curves with a radius at each of their points. Cubic ones have uniform knots: a b-spline of n
// points has n - 3 pieces and does not reach its outer points; a bezier curve of 3k + 1 points has k pieces.
struct CurvesDesc {
  enum class Basis { bspline, bezier, linear };
  Basis basis = Basis::bspline;
  // Read from a file, and then empty here; or stated by the scene itself.
  std::string filename;
  float file_radius = 0;  // of files that state none (the "hair" shape of Mitsuba 0.6); 0: the file has radii
  std::vector<Vec3f> points;
  std::vector<float> radii;          // one per point
  std::vector<std::uint32_t> first;  // the first point of each curve, and the number of points at the end
  Vec3d origin = {};                 // of the points, as in MeshData
};
struct ShapeGroupDesc {
  std::vector<int> shapes;  // indices into SceneDesc::shapes
};
struct InstanceDesc {
  int group = kNone;  // index of a shape whose kind is ShapeGroupDesc
};

struct AreaEmitterDesc {
  ColorInput radiance{Rgb(1)};
  std::string id;  // for --aov light:NAME; the shape's id if the emitter has none
  SourceLocation where;
};

struct ShapeDesc {
  std::string id;
  SourceLocation where;
  Transform to_world;
  bool flip_normals = false;
  int bsdf = kNone;  // kNone: the default diffuse BSDF
  std::optional<AreaEmitterDesc> emitter;
  bool in_group = false;  // a member of a shape group: not in the world by itself
  std::variant<MeshFileDesc, RectangleDesc, CubeDesc, SphereDesc, DiskDesc, CylinderDesc, CurvesDesc,
               ShapeGroupDesc, InstanceDesc, InlineMeshDesc>
      kind;
};

// ----------------------------------------------------------------------------------------------------
// emitters

struct PointLightDesc {
  Vec3d position;
  Rgb intensity{1};  // W/sr
};
struct SpotLightDesc {  // at the origin of to_world, along its +z
  Transform to_world;
  Rgb intensity{1};
  float cutoff_angle = 20;              // degrees: no light beyond
  float beam_width = 20 * 3.0f / 4.0f;  // degrees: full intensity within
  // Between the two, of the share s of the way from the cut-off (0) to the beam (1).
  enum class Edge {
    angle,          // s of the angle (Mitsuba)
    smooth_cosine,  // 3s² - 2s³, s of the angle's cosine (pbrt)
    squared_cosine  // s², s of the angle's cosine (glTF)
  };
  Edge edge = Edge::angle;
};
// A point light whose intensity depends on the direction as a file says; the file is opened by the world.
struct ProfileLightDesc {
  enum class Kind {
    // Photometric data (IES LM-63). At the origin of to_world; its +z is the luminaire's nadir (vertical
    // angle
    // 0), so that it is aimed like a spot light; +x is horizontal angle 0, -y horizontal angle 90 (type C;
    // counter-clockwise seen from above an upright luminaire).
    ies,
    // A square picture in the equal-area octahedral map of the directions of the local frame (as in pbrt-v4);
    // the mean of its channels.
    image
  };
  Kind kind = Kind::ies;
  Transform to_world;  // may mirror; scales mean nothing
  // ies: factor of the file's candela, which count as white divided by SceneDesc::lumens_per_unit;
  // image: W/sr where the picture is 1.
  Rgb intensity{1};
  std::string filename;
  // image, on top of `intensity`: the picture is scaled so that at an intensity of 1 the light emits this
  // (the integral of its values over the sphere).
  std::optional<float> power = std::nullopt;
  float tilt_angle = 0;  // ies: degrees away from the position in which it was measured, for its TILT factors
};
struct DirectionalLightDesc {
  Vec3f direction{0, 0, 1};  // in which the light travels
  Rgb irradiance{1};
};
struct ConstantEnvironmentDesc {
  Rgb radiance{1};
};
enum class EnvironmentProjection {
  latitude_longitude,  // +y up, as in Mitsuba
  equal_area           // pbrt-v4: octahedral (Clarberg 2008) with +z up; such pictures are square
};
struct EnvironmentMapDesc {
  std::string filename;
  float scale = 1;
  Transform to_world;
  EnvironmentProjection projection = EnvironmentProjection::latitude_longitude;
  // Equal-area maps only, on top of `scale`: what pbrt-v4 computes as the illuminance of the local +z (half
  // of the true one) is made this.
  std::optional<float> illuminance = std::nullopt;
};
struct SunSkyDesc {  // the models "sun", "sky" and "sunsky"
  bool sun = true, sky = true;
  float turbidity = 3;
  Vec3f sun_direction{0, 1, 0};  // towards the sun, in the local frame of to_world (+y up)
  float sun_scale = 1, sky_scale = 1;
  float sun_radius_scale = 1;
  Rgb albedo{0.2f};
  Transform to_world;
};
struct EmitterDesc {
  std::string id;
  SourceLocation where;
  std::variant<PointLightDesc, SpotLightDesc, ProfileLightDesc, DirectionalLightDesc, ConstantEnvironmentDesc,
               EnvironmentMapDesc, SunSkyDesc>
      kind;
};

// ------------------------------------------------------------------------------------- sensor, film,
// integrator

enum class FilterKind { box, tent, gaussian, mitchell, catmullrom, lanczos };

struct FilterDesc {
  FilterKind kind = FilterKind::box;
  float radius = 0;  // in pixels; 0: the kind's default (box 0.5, tent 1, gaussian 4σ, mitchell/catmullrom 2,
                     // lanczos = lobes)
  float stddev = 0.5f;
  float b = 1.0f / 3, c = 1.0f / 3;
  int lobes = 3;
};
struct FilmDesc {
  int width = 768, height = 576;
  int crop_x = 0, crop_y = 0, crop_width = 0, crop_height = 0;  // crop_width 0: no crop
  FilterDesc filter;
};
enum class SensorKind { perspective, thinlens, orthographic };
// all: the whole picture, whatever its proportions.
enum class FieldAxis { x, y, smaller, larger, diagonal, all };
struct SensorDesc {
  std::string id;
  SourceLocation where;
  SensorKind kind = SensorKind::perspective;
  Transform to_world;                  // camera looks along +z, +y up, +x left
  float fov_x = 39.6f;                 // degrees, across the width of the image (readers convert other axes)
  FieldAxis kept_axis = FieldAxis::x;  // along which the field stays if the film gets other proportions
  float aperture_radius = 0;           // thinlens
  float focus_distance = 1;
  float near_clip = 1e-2f, far_clip = 1e4f;
  Vec2f principal_point_offset;  // in fractions of the film
  FilmDesc film;
  int samples_per_pixel = 0;  // 0: not stated
};

struct Warning {
  SourceLocation where;
  std::string what;          // names the thing that Lumirank does not have
  std::string used_instead;  // "" if it is left out
  bool harmless = false;     // only a note: no picture shows the difference, so --strict lets it pass
};

struct SceneDesc {
  std::string source_file;
  std::string format;  // "mitsuba 0.6", "mitsuba 3.0", …
  // Photometric value of a radiometric quantity whose luminance() is 1: cd/m² of radiance, lux of irradiance,
  // cd of intensity. The default: units of W/nm (base/photometry.h); 1: the scene is in photometric units.
  double lumens_per_unit = kLumensPerUnit;
  std::vector<TextureDesc> textures;
  std::vector<BsdfDesc> bsdfs;
  std::vector<ShapeDesc> shapes;
  std::vector<EmitterDesc> emitters;
  std::vector<SensorDesc> sensors;  // at least one after a successful read
  int max_depth = -1;               // Mitsuba's count; -1: unlimited
  std::string integrator;           // as named in the file
  std::vector<Warning> warnings;
};

}  // namespace lumirank::scenedesc
