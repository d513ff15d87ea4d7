#include "scenedesc/schema/describe.h"

#include <algorithm>
#include <cstdarg>
#include <cstdio>
#include <memory>
#include <type_traits>

#include "scenedesc/schema/film_size.h"

namespace lumirank::scenedesc {

namespace {

template <typename... Visitors>
struct Overloaded : Visitors... {
  using Visitors::operator()...;
};
template <typename... Visitors>
Overloaded(Visitors...) -> Overloaded<Visitors...>;

std::string num(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.6g", value);
  return text;
}
std::string show(Rgb c) {
  return c.r == c.g && c.g == c.b ? num(c.r) : "(" + num(c.r) + ", " + num(c.g) + ", " + num(c.b) + ")";
}
std::string show(Vec3d v) { return "(" + num(v.x) + ", " + num(v.y) + ", " + num(v.z) + ")"; }
std::string show(const ColorInput& c) {
  return c.texture == kNone ? show(c.value) : "texture " + std::to_string(c.texture);
}
std::string show(const FloatInput& f) {
  return f.texture == kNone ? num(f.value) : "texture " + std::to_string(f.texture);
}
std::string show(const Transform& t) {
  if (t.is_identity()) return "";
  std::string text = ", to_world [";
  for (std::size_t i = 0; i < 12; ++i) text += (i ? (i % 4 ? " " : "; ") : "") + num(t.m[i]);
  return text + "]";
}
std::string show(const UvTransform& t) {
  std::string text = "[";
  for (int i = 0; i < 6; ++i) text += (i ? (i % 3 ? " " : "; ") : "") + num(t.m[i]);
  return text + "]";
}
std::string b(int index) { return index == kNone ? "none" : "bsdf " + std::to_string(index); }
const char* show(TextureChannel channel) {
  constexpr const char* kNames[] = {
      "", ", red alone", ", green alone", ", blue alone", ", alpha alone", ", as a number"};
  return kNames[static_cast<int>(channel)];
}
const char* show(WrapMode mode) {
  return mode == WrapMode::repeat ? "repeat" : (mode == WrapMode::mirror ? "mirror" : "clamp");
}

std::string kind(const TextureDesc& t) {
  return std::visit(
      Overloaded{
          [](const BitmapTextureDesc& x) {
            return "bitmap " + x.filename + (x.bytes ? ", embedded" : "") + (x.raw ? ", raw" : "") +
                   show(x.channel) + (x.filter == FilterMode::nearest ? ", nearest" : "") + ", wrap " +
                   show(x.wrap_u) + " × " + show(x.wrap_v) + ", to_uv " + show(x.to_uv);
          },
          [](const CheckerboardTextureDesc& x) {
            return "checkerboard " + show(x.color0) + " and " + show(x.color1) + ", to_uv " + show(x.to_uv);
          },
          [](const ScaleTextureDesc& x) { return "scale of " + show(x.input) + " by " + show(x.scale); },
          [](const ProductTextureDesc& x) { return "product of " + show(x.a) + " and " + show(x.b); },
          [](const MixTextureDesc& x) {
            return "mix of " + show(x.a) + " and " + show(x.b) + " by " + show(x.amount);
          },
          [](const RootTextureDesc& x) { return "square root of " + show(x.input); },
          [](const ThresholdTextureDesc& x) { return show(x.input) + " cut at " + num(x.threshold); },
          [](const VertexColorTextureDesc& x) { return "vertex colors \"" + x.attribute + "\""; }},
      t.kind);
}

std::string show(float value) { return num(value); }
std::string show(bool value) { return value ? "true" : "false"; }
const char* show(Distribution d) { return d == Distribution::ggx ? "ggx" : "beckmann"; }
const char* show(WardDesc::Variant v) {
  constexpr const char* kNames[] = {"ward", "ward-duer", "balanced"};
  return kNames[static_cast<int>(v)];
}

bool is_zero(const FloatInput& f) { return f.texture == kNone && f.value == 0; }

template <typename Desc>
std::string bsdf_kind(const Desc& desc) {
  bool smooth = false;  // then the distribution of microfacets means nothing
  if constexpr (requires {
                  desc.distribution;
                  desc.alpha_u;
                })
    smooth = is_zero(desc.alpha_u) && is_zero(desc.alpha_v);
  else if constexpr (requires { desc.distribution; })
    smooth = is_zero(desc.alpha);
  std::string text, separator = " ";
  for_each_field(desc, [&](const auto& field, const auto& value) {
    using Value = std::decay_t<decltype(value)>;
    if (smooth && field.role == Role::roughness) {
      text += std::is_same_v<Value, Distribution> ? separator + "smooth" : "";
    } else if constexpr (std::is_same_v<Value, FileInput>) {
      text += separator + field.name + " " + value.name;
    } else if constexpr (std::is_same_v<Value, int>) {
      text += separator + field.name + " " + (field.role == Role::nested ? b(value) : std::to_string(value));
    } else {
      text += separator + field.name + " " + show(value);
    }
    separator = ", ";
  });
  return Desc::kInfo.name + text;
}
std::string bsdf_kind(const MixtureDesc& mixture) {
  std::string text = "mixture";
  for (const auto& part : mixture.parts)
    text += std::string(" ") + (part.complement ? "(1 - " + show(part.weight) + ")" : show(part.weight)) +
            " of " + b(part.bsdf);
  return text;
}
std::string kind(const BsdfDesc& desc) {
  return std::visit([](const auto& x) { return bsdf_kind(x); }, desc.kind);
}

std::string kind(const ShapeDesc& s) {
  return std::visit(
      Overloaded{
          [](const MeshFileDesc& x) {
            std::string text = std::string(x.format == MeshFormat::obj   ? "obj "
                                           : x.format == MeshFormat::ply ? "ply "
                                                                         : "serialized ") +
                               x.filename;
            if (x.format == MeshFormat::serialized) text += " [" + std::to_string(x.shape_index) + "]";
            if (x.face_normals) text += ", face normals";
            if (x.flip_tex_coords) text += ", v flipped";
            if (!x.smooth_without_normals) text += ", its own normals only";
            if (x.max_smooth_angle) text += ", smooth up to " + num(*x.max_smooth_angle) + "°";
            return text;
          },
          [](const RectangleDesc&) { return std::string("rectangle"); },
          [](const CubeDesc&) { return std::string("cube"); },
          [](const SphereDesc& x) { return "sphere at " + show(x.center) + ", radius " + num(x.radius); },
          [](const DiskDesc&) { return std::string("disk"); },
          [](const CylinderDesc& x) {
            return "cylinder " + show(x.p0) + " to " + show(x.p1) + ", radius " + num(x.radius);
          },
          [](const CurvesDesc& x) {
            constexpr const char* kBases[] = {"bspline", "bezier", "linear"};
            std::string text = std::string(kBases[static_cast<int>(x.basis)]) + " curves";
            if (!x.filename.empty()) return text + " " + x.filename;
            const std::size_t curves = x.first.empty() ? 0 : x.first.size() - 1;
            return text + ", " + std::to_string(curves) + " of " + std::to_string(x.points.size()) +
                   " points";
          },
          [](const ShapeGroupDesc& x) {
            std::string text = "group of shapes";
            for (const int shape : x.shapes) text += " " + std::to_string(shape);
            return text;
          },
          [](const InstanceDesc& x) { return "instance of shape " + std::to_string(x.group); },
          [](const InlineMeshDesc& x) {
            if (!x.mesh) return "mesh " + x.name + " (missing)";
            return "mesh " + x.name + " of " + std::to_string(x.mesh->triangle_count()) + " triangles" +
                   (x.mesh->normals.empty() ? ", face normals" : "");
          }},
      s.kind);
}

std::string kind(const EmitterDesc& e) {
  return std::visit(
      Overloaded{[](const PointLightDesc& x) {
                   return "point at " + show(x.position) + ", intensity " + show(x.intensity);
                 },
                 [](const SpotLightDesc& x) {
                   const char* edges[] = {"", ", smooth edge", ", squared edge", ", quartic edge"};
                   return "spot" + std::string(edges[static_cast<int>(x.edge)]) + ", intensity " +
                          show(x.intensity) + ", cutoff " + num(x.cutoff_angle) + "°, beam " +
                          num(x.beam_width) + "°" + show(x.to_world);
                 },
                 [](const ProfileLightDesc& x) {
                   return std::string(x.kind == ProfileLightDesc::Kind::ies ? "ies " : "goniometric ") +
                          x.filename + ", intensity × " + show(x.intensity) +
                          (x.power ? ", power " + num(*x.power) : "") +
                          (x.tilt_angle != 0 ? ", tilted by " + num(x.tilt_angle) + "°" : "") +
                          show(x.to_world);
                 },
                 [](const ProjectionLightDesc& x) {
                   std::string text = "projection of " + show(x.picture);
                   if (x.means == ProjectionLightDesc::Picture::irradiance) text += " as irradiance";
                   text += " × " + show(x.intensity) + ", field " + num(x.fov) + "° along " +
                           name_of(x.axis) + (x.square ? " of a square" : "") + ", to_uv " + show(x.to_uv);
                   if (x.cutoff_angle > 0)
                     text += ", cutoff " + num(x.cutoff_angle) + "°, beam " + num(x.beam_width) + "°";
                   return text + (x.power ? ", power " + num(*x.power) : "") + show(x.to_world);
                 },
                 [](const DirectionalLightDesc& x) {
                   return "directional " + show(x.direction) + ", irradiance " + show(x.irradiance);
                 },
                 [](const ConstantEnvironmentDesc& x) { return "constant, radiance " + show(x.radiance); },
                 [](const EnvironmentMapDesc& x) {
                   return "envmap " + x.filename + ", scale " + num(x.scale) +
                          (x.projection == EnvironmentProjection::equal_area ? ", equal-area" : "") +
                          (x.illuminance ? ", illuminance " + num(*x.illuminance) : "") +
                          (x.tint == Rgb(1) ? "" : ", tint " + show(x.tint)) + show(x.to_world);
                 },
                 [](const SunSkyDesc& x) {
                   return std::string(x.sun ? (x.sky ? "sunsky" : "sun") : "sky") + ", turbidity " +
                          num(x.turbidity) + (x.sun_model == SunModel::preetham ? ", Preetham's sun" : "") +
                          ", sun towards " + show(x.sun_direction) + ", scales " + num(x.sun_scale) +
                          " and " + num(x.sky_scale) + ", radius × " + num(x.sun_radius_scale) + ", albedo " +
                          show(x.albedo) + show(x.to_world);
                 }},
      e.kind);
}

std::string m(int index) { return index == kNone ? "none" : "medium " + std::to_string(index); }
std::string show(const VolumeInput& input) {
  if (input.volume == kNone) return show(input.value);
  return (input.value == Rgb(1) ? "" : show(input.value) + " × ") + "volume " + std::to_string(input.volume);
}
std::string show(const PhaseLobeDesc& lobe) {
  if (is_black(lobe.g)) return "isotropic";
  return (lobe.kind == PhaseLobeDesc::Kind::schlick ? "schlick " : "hg ") + show(lobe.g);
}

std::string show(const GridFileDesc& file) {
  return "grid " + (file.grid.empty() ? "" : "\"" + file.grid + "\" of ") + file.filename +
         (file.use_grid_box ? ", in its own box" : "");
}

std::string kind(const VolumeDesc& v) {
  constexpr const char* kSamplings[] = {", from face to face", "", ", fading at the faces"};
  const auto show_grid = Overloaded{[](const GridFileDesc& x) { return show(x); },
                                    [](const std::shared_ptr<const GridData>& x) {
                                      const auto& [nx, ny, nz] = x->size;
                                      std::string text = "grid of " + std::to_string(nx) + " × " +
                                                         std::to_string(ny) + " × " + std::to_string(nz) +
                                                         (x->channels == 1 ? " numbers" : " colors");
                                      if (!(x->lo == Vec3f{0, 0, 0} && x->hi == Vec3f{1, 1, 1}))
                                        text += ", box " + show(x->lo) + " to " + show(x->hi);
                                      return text;
                                    }};
  const auto* file = std::get_if<GridFileDesc>(&v.kind);
  return std::visit(show_grid, v.kind) +
         (file && file->sparse() ? "" : kSamplings[static_cast<int>(v.sampling)]) +
         (v.nearest ? ", nearest" : "") + show(v.to_world);
}

std::string kind(const MediumDesc& medium) {
  std::string text =
      medium.form == MediumDesc::Form::extinction_and_albedo
          ? "extinction " + show(medium.extinction) + ", albedo " + show(medium.albedo)
          : "absorption " + show(medium.absorption) + ", scattering " + show(medium.scattering);
  if (!is_black(medium.emission.value)) text += ", emission " + show(medium.emission);
  text += ", phase function ";
  if (medium.phase.empty()) return text + "isotropic";
  if (medium.phase.size() == 1) return text + show(medium.phase[0]);
  for (std::size_t k = 0; k < medium.phase.size(); ++k)
    text += (k == 0 ? "" : " and ") + num(medium.phase[k].weight) + " of " + show(medium.phase[k]);
  return text;
}

std::string head(std::size_t index, const std::string& id) {
  return "  " + std::to_string(index) + (id.empty() ? "" : " \"" + id + "\"") + ": ";
}

std::string show(const SensorDesc& s) {
  const char* kinds[] = {"perspective", "thinlens", "orthographic"};
  const char* filters[] = {"box", "tent", "gaussian", "mitchell", "catmullrom", "lanczos"};
  const FilmDesc& f = s.film;
  std::string text = std::string(kinds[static_cast<int>(s.kind)]) + " " + std::to_string(f.width) + " × " +
                     std::to_string(f.height);
  if (f.crop_width > 0)
    text += " (crop " + std::to_string(f.crop_width) + " × " + std::to_string(f.crop_height) + " at " +
            std::to_string(f.crop_x) + ", " + std::to_string(f.crop_y) + ")";
  if (s.kind != SensorKind::orthographic) text += ", fov_x " + num(s.fov_x) + "°";
  if (s.kind == SensorKind::thinlens)
    text += ", aperture " + num(s.aperture_radius) + ", focus " + num(s.focus_distance);
  text += std::string(", filter ") + filters[static_cast<int>(f.filter.kind)];
  if (s.samples_per_pixel > 0) text += ", " + std::to_string(s.samples_per_pixel) + " samples per pixel";
  if (s.medium != kNone) text += ", in " + m(s.medium);
  return text + show(s.to_world);
}

}  // namespace

std::string describe(const SceneDesc& scene) {
  std::string text = scene.source_file + " (" + scene.format + ")\n";
  text += "integrator " + (scene.integrator.empty() ? "not stated" : scene.integrator) + ", depth " +
          (scene.max_depth < 0 ? "unlimited" : std::to_string(scene.max_depth)) + "\n";
  text += std::to_string(scene.sensors.size()) + " sensors\n";
  for (std::size_t i = 0; i < scene.sensors.size(); ++i)
    text += head(i, scene.sensors[i].id) + show(scene.sensors[i]) + "\n";
  text += std::to_string(scene.emitters.size()) + " emitters besides shapes\n";
  for (std::size_t i = 0; i < scene.emitters.size(); ++i)
    text += head(i, scene.emitters[i].id) + kind(scene.emitters[i]) + "\n";
  text += std::to_string(scene.textures.size()) + " textures\n";
  for (std::size_t i = 0; i < scene.textures.size(); ++i)
    text += head(i, scene.textures[i].id) + kind(scene.textures[i]) + "\n";
  text += std::to_string(scene.bsdfs.size()) + " BSDFs\n";
  for (std::size_t i = 0; i < scene.bsdfs.size(); ++i)
    text += head(i, scene.bsdfs[i].id) + kind(scene.bsdfs[i]) + "\n";
  // Most scenes have neither.
  if (!scene.volumes.empty()) text += std::to_string(scene.volumes.size()) + " volumes\n";
  for (std::size_t i = 0; i < scene.volumes.size(); ++i)
    text += head(i, scene.volumes[i].id) + kind(scene.volumes[i]) + "\n";
  if (!scene.media.empty()) text += std::to_string(scene.media.size()) + " media\n";
  for (std::size_t i = 0; i < scene.media.size(); ++i)
    text += head(i, scene.media[i].id) + kind(scene.media[i]) + "\n";
  text += std::to_string(scene.shapes.size()) + " shapes\n";
  for (std::size_t i = 0; i < scene.shapes.size(); ++i) {
    const ShapeDesc& s = scene.shapes[i];
    text += head(i, s.id) + kind(s) + (s.bsdf == kNone ? "" : ", " + b(s.bsdf)) +
            (s.media.divides ? ", inside " + m(s.media.inside) + ", outside " + m(s.media.outside) : "") +
            (s.flip_normals ? ", normals flipped" : "") + (s.in_group ? ", in a group" : "") +
            (s.emitter ? ", radiance " + show(s.emitter->radiance) : "") + show(s.to_world) + "\n";
  }
  return text;
}

}  // namespace lumirank::scenedesc
