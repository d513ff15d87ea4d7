#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <limits>
#include <nlohmann/json.hpp>

#include "image/false_color.h"
#include "image/srgb.h"
#include "pages/html_text.h"
#include "pages/sections.h"

namespace lumirank::pages {
namespace {

struct Choice {
  std::string name, about, image, error;
  double relative_l1 = std::numeric_limits<double>::infinity();
};

std::vector<Choice> choices_of(const Comparison& results, const ComparisonSummary& summary) {
  std::vector<Choice> choices;
  if (!results.reference_image.empty())
    choices.push_back({"Reference", results.reference_kind, results.reference_image, ""});
  for (const ComparisonGroup& group : summary.groups)
    for (const ComparisonRun* run : group.runs) {
      if (run->image_file.empty()) continue;
      const std::string seed = group.runs.size() > 1 ? ", seed " + std::to_string(run->seed) : "";
      choices.push_back({run->label + seed,
                         show_percent(run->error.relative_l1) + " L1, " + show_seconds(run->seconds),
                         run->image_file, run->error_image_file, run->error.relative_l1});
    }
  return choices;
}

// For a <script>: no "<" may occur in it.
std::string to_json(const std::vector<Choice>& choices) {
  auto list = nlohmann::json::array();
  for (const Choice& c : choices)
    list.push_back({{"name", c.name},
                    {"about", c.about},
                    {"image", escape_url(c.image)},
                    {"error", escape_url(c.error)}});
  const std::string text = list.dump(-1, ' ', true, nlohmann::json::error_handler_t::replace);
  std::string safe;
  for (const char c : text) safe += c == '<' ? std::string("\\u003c") : std::string(1, c);
  return safe;
}

std::string gradient() {
  std::string out = "linear-gradient(to right";
  constexpr int stops = 24;
  for (int i = 0; i <= stops; ++i) {
    const Rgb c = image::false_color(static_cast<float>(i) / stops);
    char hex[16];
    const auto byte = [](float v) { return static_cast<unsigned>(std::lround(255 * image::srgb_encode(v))); };
    std::snprintf(hex, sizeof hex, ",#%02x%02x%02x", byte(c.r), byte(c.g), byte(c.b));
    out += hex;
  }
  return out + ")";
}

std::string select(const char* side, const char* label, const std::vector<Choice>& choices,
                   std::size_t chosen) {
  std::string out = std::string("<label>") + label + " <select id=\"choose-" + side + "\">";
  for (std::size_t k = 0; k < choices.size(); ++k)
    out += "<option value=\"" + std::to_string(k) + "\"" + (k == chosen ? " selected=\"selected\"" : "") +
           ">" + escape_html(choices[k].name) + "</option>";
  return out + "</select></label>";
}

}  // namespace

std::string image_section(const Comparison& results, const ComparisonSummary& summary) {
  const std::vector<Choice> choices = choices_of(results, summary);
  if (choices.empty()) return {};
  // At first: the reference beside the run that comes nearest to it.
  const auto nearest = std::min_element(choices.begin(), choices.end(), [](const Choice& a, const Choice& b) {
    return a.relative_l1 < b.relative_l1;
  });
  const auto right = static_cast<std::size_t>(nearest - choices.begin());
  // Small pictures are enlarged, large ones fit the page.
  const int width = std::max(results.width, 640);
  std::string out =
      "<section><h2>Images</h2>\n<div class=\"bar\">" + select("left", "Left", choices, 0) +
      "<button type=\"button\" id=\"swap\" title=\"Swap\" aria-label=\"Swap left and right\">⇄</button>" +
      select("right", "Right", choices, right) +
      "<div class=\"choice\" role=\"radiogroup\" aria-label=\"What is shown\"><label><input type=\"radio\" "
      "name=\"view\" "
      "value=\"images\" checked=\"checked\"/><span>images</span></label><label><input type=\"radio\" "
      "name=\"view\" "
      "value=\"errors\"/><span>errors</span></label></div></div>\n";
  const std::string alt_right = escape_html(choices[right].name);
  out += "<div class=\"stage\" id=\"stage\" style=\"max-width:" + std::to_string(width) +
         "px\"><img id=\"right\" src=\"" + escape_url(choices[right].image) + "\" alt=\"" + alt_right +
         "\"/><img id=\"left\" src=\"" + escape_url(choices[0].image) + "\" alt=\"" +
         escape_html(choices[0].name) +
         "\"/><span class=\"badge l\" id=\"badge-left\"></span><span class=\"badge r\" "
         "id=\"badge-right\"></span><input "
         "type=\"range\" id=\"split\" min=\"0\" max=\"100\" step=\"0.1\" value=\"50\" aria-label=\"Where the "
         "left image ends\"/><div "
         "class=\"handle\" id=\"handle\"></div></div>\n";
  const double full = results.error_full_scale;
  out += "<div class=\"colorbar off\" id=\"colorbar\"><div class=\"ramp\" style=\"background:" + gradient() +
         "\"></div><div class=\"ends\"><span>0</span><span>" + show_percent(full / 2) + "</span><span>" +
         show_percent(full) +
         " and more</span></div><div>|image − reference| over the mean of the reference; the reference "
         "itself is shown as it "
         "is</div></div>\n";
  return out + "<script type=\"application/json\" id=\"images\">" + to_json(choices) +
         "</script></section>\n";
}

}  // namespace lumirank::pages
