#include <charconv>
#include <cmath>
#include <functional>
#include <set>

#include "pages/html_text.h"
#include "pages/sections.h"
#include "pages/svg_plot.h"

namespace lumirank::pages {
namespace {

std::string sort_key(double value) {
  if (!std::isfinite(value)) return "";
  char text[32];
  return {text, std::to_chars(text, text + sizeof text, value).ptr};
}

std::string head(const std::string& name, const char* hint = "") {
  return std::string("<th scope=\"col\"") + (*hint ? " title=\"" + escape_html(hint) + "\"" : "") +
         "><button type=\"button\">" + escape_html(name) + "</button></th>";
}

std::string cell(double value, const std::string& shown) {
  return "<td data-value=\"" + sort_key(value) + "\">" + escape_html(shown) + "</td>";
}

std::string name_cell(const ComparisonGroup& group) {
  std::string out = "<td><span class=\"name\">" + svg_swatch(static_cast<int>(group.series)) + "<span>" +
                    escape_html(group.first().label);
  return out + "</span></span></td>";
}

struct Column {
  const char* name;
  const char* hint;
  std::function<double(const ComparisonRun&)> value;
  std::string (*show)(double);
};

const Column kColumns[] = {
    {"Time", "of the method", [](const ComparisonRun& r) { return r.seconds; }, show_seconds},
    {"Setup", "receivers, virtual lights and matrix, which all methods need",
     [](const ComparisonRun& r) { return r.setup_seconds; }, show_seconds},
    {"Rays", "shadow rays", [](const ComparisonRun& r) { return r.rays; }, show_count},
    {"Entries", "matrix entries evaluated", [](const ComparisonRun& r) { return r.entries; }, show_count},
    {"Sampled", "entries evaluated over entries of the matrix",
     [](const ComparisonRun& r) { return r.sampling_rate; }, show_percent},
    {"Rel. L1", "Σ|I−R| / ΣR", [](const ComparisonRun& r) { return r.error.relative_l1; }, show_percent},
    {"Rel. L2", "‖I−R‖₂ / ‖R‖₂", [](const ComparisonRun& r) { return r.error.relative_l2; }, show_percent},
    {"RMSE", "", [](const ComparisonRun& r) { return r.error.rmse; }, show_number},
    {"relMSE", "mean of (I−R)² / (R² + (mean(R)/100)²)",
     [](const ComparisonRun& r) { return r.error.relmse; }, show_number},
    {"FLIP", "how different it looks, 0 to 1; – where the reference is known at some pixels only",
     [](const ComparisonRun& r) { return r.error.flip; }, show_number},
    {"Bias", "Σ(I−R) / ΣR", [](const ComparisonRun& r) { return r.error.bias; }, show_percent},
};

}  // namespace

std::string table_section(const ComparisonSummary& summary) {
  if (summary.groups.empty()) return {};
  std::string out =
      "<section><h2>All settings</h2>\n<p class=\"soft\">Click a heading to sort by it.</p>\n<div "
      "class=\"scroll\"><table id=\"runs\"><thead><tr>" +
      head("Method and settings");
  const bool seeds = summary.max_seeds > 1;
  if (seeds) out += head("Seeds", "the other numbers are means over them");
  for (const Column& column : kColumns) out += head(column.name, column.hint);
  out += "</tr></thead><tbody>\n";
  for (const ComparisonGroup& group : summary.groups) {
    out += "<tr>" + name_cell(group);
    if (seeds) out += cell(static_cast<double>(group.runs.size()), std::to_string(group.runs.size()));
    for (const Column& column : kColumns) {
      const double mean = group.mean(column.value);
      out += cell(mean, column.show(mean));
    }
    out += "</tr>\n";
  }
  return out + "</tbody></table></div></section>\n";
}

std::string phase_section(const ComparisonSummary& summary) {
  std::set<std::string> phases;
  for (const ComparisonGroup& group : summary.groups)
    for (const ComparisonRun* run : group.runs)
      for (const auto& [phase, seconds] : run->phases) phases.insert(phase);
  if (phases.empty()) return {};
  std::string out =
      "<section><h2>Seconds per phase</h2>\n<div class=\"scroll\"><table id=\"phases\"><thead><tr>" +
      head("Method and settings");
  for (const std::string& phase : phases) out += head(phase);
  out += head("Total") + "</tr></thead><tbody>\n";
  for (const ComparisonGroup& group : summary.groups) {
    if (group.first().phases.empty()) continue;
    out += "<tr>" + name_cell(group);
    for (const std::string& phase : phases) {
      const double mean = group.mean([&](const ComparisonRun& r) {
        const auto found = r.phases.find(phase);
        return found == r.phases.end() ? std::nan("") : found->second;
      });
      out += cell(mean, show_seconds(mean));
    }
    const double total = group.mean([](const ComparisonRun& r) { return r.seconds; });
    out += cell(total, show_seconds(total)) + "</tr>\n";
  }
  return out + "</tbody></table></div></section>\n";
}

}  // namespace lumirank::pages
