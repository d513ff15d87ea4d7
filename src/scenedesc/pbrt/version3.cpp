#include "scenedesc/pbrt/version3.h"

#include <algorithm>
#include <cmath>

#include "scenedesc/pbrt/reader.h"

namespace lumirank::scenedesc::pbrt {

bool is_version3(std::string_view text) {
  // A directive stands at the beginning of a line, or after a space; what follows is empty but for comments.
  constexpr std::string_view kEnd = "WorldEnd";
  const std::size_t at = text.rfind(kEnd);
  if (at == std::string_view::npos) return false;
  const std::size_t line = text.rfind('\n', at) + 1;  // 0 on the first one
  if (text.substr(line, at - line).find_first_of("#\"") != std::string_view::npos) return false;
  return text.find('"', at) == std::string_view::npos;
}

void upgrade_film(Params& p, std::string& type) {
  if (type == "image") type = "rgb";
  p.rename("maxsampleluminance", "maxcomponentvalue");
}

void upgrade_filter(Params& p, const std::string& type) {
  p.rename("xwidth", "xradius");
  p.rename("ywidth", "yradius");
  if (type != "gaussian") return;
  // exp(-α d²).
  const float alpha = p.positive("alpha", 2);
  p.add_number("sigma", 1 / std::sqrt(2 * alpha));
  if (!p.has("xradius")) p.add_number("xradius", 2);
  if (!p.has("yradius")) p.add_number("yradius", 2);
}

void upgrade_camera(Params& p, std::string& type) {
  if (type == "environment") type = "spherical";
  if (p.has("halffov") && !p.has("fov")) p.add_number("fov", 2 * p.number("halffov", 45));
  p.ignore({"halffov", "simpleweighting"});
}

void upgrade_light(Params& p, const std::string& type) {
  if (type == "infinite" || type == "goniometric" || type == "projection") p.rename("mapname", "filename");
  // Exporters write an empty name where there is no map.
  if (p.text("filename", " ").empty()) p.drop("filename");
  p.ignore({"samples", "nsamples"});
}

void upgrade_area_light(Params& p, std::string& type) {
  if (type == "area") type = "diffuse";
  p.ignore({"samples", "nsamples"});
}

void upgrade_shape(Params& p, const std::string& type) {
  if (type == "loopsubdiv") p.rename("nlevels", "levels");
  // Beside "alpha" pbrt-v3 has it once more for shadow rays, as a rule the same.
  p.ignore({"shadowalpha", "discarddegenerateUVs"});
}

void upgrade_texture(Params& p, const std::string& kind) {
  if (kind == "imagemap") {
    if (p.has("gamma") && !p.flag("gamma", true)) p.add_text("encoding", "linear");
    p.ignore({"gamma", "trilinear"});
  } else if (kind == "scale") {
    p.rename("tex1", "tex");
    p.rename("tex2", "scale");
  } else if (kind == "checkerboard") {
    p.ignore({"aamode"});
  }
}

void upgrade_medium(Params& p) {
  const std::string type = p.text("type", "");
  if (type == "heterogeneous") p.replace_text("type", "uniformgrid");
}

float alpha_of_version3(float roughness) {
  const float x = std::log(std::max(roughness, 1e-3f));
  return 1.62142f + x * (0.819955f + x * (0.1734f + x * (0.0171201f + x * 0.000640711f)));
}

}  // namespace lumirank::scenedesc::pbrt
