// What is shown and written: some of these settings have a syntax of their own.
#include <algorithm>
#include <cmath>

#include "settings/table.h"

namespace lumirank::settings {
namespace {

Row size_row() {
  return {{"size", "text", "", "WxH, each 1 … 65536", "pixels", "resolution; default: as the scene says"},
          [](RenderSettings& s, const std::string& text) {
            if (text.empty()) return void(s.view.width = s.view.height = 0);
            const auto parts = split_settings(text, 'x');
            if (parts.size() != 2) throw InputError("'" + text + "' is not a size", "write it as 800x600");
            const int w = parse_number<int>("size", parts[0]), h = parse_number<int>("size", parts[1]);
            if (w < 1 || h < 1 || w > 65536 || h > 65536)
              throw InputError("the size " + text + " is out of range", "width and height lie in 1 … 65536");
            s.view.width = w, s.view.height = h;
          },
          [](const RenderSettings& s) {
            return s.view.width > 0 ? std::to_string(s.view.width) + "x" + std::to_string(s.view.height)
                                    : std::string{};
          }};
}

Row crop_row() {
  return {{"crop", "text", "", "X,Y,W,H", "pixels", "render only this window of the film"},
          [](RenderSettings& s, const std::string& text) {
            if (text.empty()) return void(s.view.crop.fill(0));
            const auto parts = split_settings(text, ',');
            if (parts.size() != 4) throw InputError("'" + text + "' is not a crop", "write it as X,Y,W,H");
            for (std::size_t i = 0; i < 4; ++i) s.view.crop[i] = parse_number<int>("crop", parts[i]);
            if (s.view.crop[0] < 0 || s.view.crop[1] < 0 || s.view.crop[2] < 1 || s.view.crop[3] < 1)
              throw InputError("the crop " + text + " is negative or empty");
            if (*std::max_element(s.view.crop.begin(), s.view.crop.end()) > 65536)
              throw InputError("the crop " + text + " is out of range",
                               "no film is larger than 65536 pixels");
          },
          [](const RenderSettings& s) {
            if (s.view.crop[2] == 0) return std::string{};
            return std::to_string(s.view.crop[0]) + "," + std::to_string(s.view.crop[1]) + "," +
                   std::to_string(s.view.crop[2]) + "," + std::to_string(s.view.crop[3]);
          }};
}

// What it is where it is not given depends on `spp`.
Row film_samples_row() {
  Row row = number({"film-samples", "", "16", "0 … 4096", "film samples per pixel",
                    "eye rays for edges and textures, which take their light from the receivers near them; "
                    "0, and by default from --spp 16 on: the receivers alone"},
                   At<&RenderSettings::view, &ViewSettings::film_samples>{}, 0, 4096);
  row.get = [](const RenderSettings& s) { return std::to_string(s.view.film_samples_or_default()); };
  return row;
}

Row shutter_row() {
  return {
      {"shutter", "text", "", "CLOSE or OPEN:CLOSE, each -1000 … 1000", "frames",
       "motion blur: the shutter is open from OPEN (0 if not given) to CLOSE frames after the moment; 0.5 is "
       "a shutter of 180°"},
      [](RenderSettings& s, const std::string& text) {
        s.view.shutter_open = s.view.shutter_close = 0;
        if (text.empty()) return;
        const auto parts = split_settings(text, ':');
        if (parts.size() > 2)
          throw InputError("'" + text + "' is not a shutter", "write it as 0.5, or as -0.25:0.25");
        const double close = parse_number<double>("shutter", parts.back()),
                     open = parts.size() == 2 ? parse_number<double>("shutter", parts[0]) : 0;
        if (std::max(std::abs(open), std::abs(close)) > 1000)
          throw InputError("the shutter " + text + " is out of range", "it counts in frames, -1000 … 1000");
        if (close < open)
          throw InputError("the shutter " + text + " closes before it opens",
                           "give OPEN:CLOSE with the earlier one first");
        s.view.shutter_open = open, s.view.shutter_close = close;
      },
      [](const RenderSettings& s) {
        return s.view.shutter_open == s.view.shutter_close
                   ? std::string{}
                   : format_number(s.view.shutter_open) + ":" + format_number(s.view.shutter_close);
      }};
}

bool known_aov(const std::string& name) {
  if (name.starts_with("light:") && name.size() > 6) return true;
  static const std::vector<std::string> names = {"direct", "indirect", "emission", "illuminance", "albedo",
                                                 "normal", "depth",    "position", "samples"};
  return std::find(names.begin(), names.end(), name) != names.end();
}

Row aov_row() {
  return {{"aov", "list", "",
           "direct,indirect,emission,illuminance,albedo,normal,depth,position,samples,light:NAME,light:*", "",
           "further EXR layers, separated by commas; light:NAME is the part of one emitter or group, light:* "
           "all of them"},
          [](RenderSettings& s, const std::string& text) {
            s.layers.clear();
            if (text.empty()) return;
            for (const auto& name : split_settings(text, ',')) {
              if (name.empty())
                throw InputError("'" + text + "' has an empty name among its AOVs",
                                 "write them as albedo,depth");
              if (!known_aov(name))
                throw InputError(
                    "'" + name + "' is not an AOV",
                    "choose from direct, indirect, emission, illuminance, albedo, normal, depth, position, "
                    "samples, light:NAME");
              if (std::find(s.layers.begin(), s.layers.end(), name) == s.layers.end())
                s.layers.push_back(name);
            }
          },
          [](const RenderSettings& s) {
            std::string joined;
            for (const auto& a : s.layers) joined += (joined.empty() ? "" : ",") + a;
            return joined;
          }};
}

}  // namespace

void add_view_rows(std::vector<Row>& t) {
  using S = RenderSettings;
  t.push_back(size_row());
  t.push_back(number({"spp", "", "4", "1 … 4096", "receivers per pixel",
                      "places per pixel at which light is gathered (4 = 2×2)"},
                     At<&S::view, &ViewSettings::spp>{}, 1, 4096));
  t.push_back(film_samples_row());
  t.push_back(number({"max-depth", "", "0", "-1 … 1000000", "bounces",
                      "longest path, 1: emission only, 2: direct light; 0: as the scene says; -1: unlimited"},
                     At<&S::view, &ViewSettings::max_depth>{}, -1, 1e6));
  t.push_back(
      number({"clamp", "", "0.03", "0 … 1e9", "", "bound on a_j·G·(π f_x)(π f_y) of one entry; 0: off"},
             At<&S::lights, &VirtualLightSettings::clamp>{}, 0, 1e9));
  t.push_back(
      choice({"only", "", "all", "", "", "leave out the other part"}, At<&S::view, &ViewSettings::only>{}));
}

void add_output_rows(std::vector<Row>& t) {
  using S = RenderSettings;
  t.push_back(text_field({"camera", "", "", "", "", "id of the scene's sensor; default: the first"},
                         At<&S::view, &ViewSettings::camera>{}));
  t.push_back(crop_row());
  t.push_back(aov_row());
  t.push_back(shutter_row());
  t.push_back(number({"shutter-samples", "", "16", "1 … 1024", "instants",
                      "instants of which a picture with --shutter is made; a reference takes 64 by default"},
                     At<&S::view, &ViewSettings::shutter_samples>{}, 1, 1024));
}

}  // namespace lumirank::settings
