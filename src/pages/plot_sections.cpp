#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

#include "pages/html_text.h"
#include "pages/sections.h"
#include "pages/svg_plot.h"

namespace lumirank::pages {
namespace {

using Value = std::function<double(const ComparisonRun&)>;

struct Measure {
  const char* key;
  const char* name;
  Unit unit;
  Value value;
};

const Measure kMeasures[] = {
    {"l1", "relative L1", Unit::percent, [](const ComparisonRun& r) { return r.error.relative_l1; }},
    {"l2", "relative L2", Unit::percent, [](const ComparisonRun& r) { return r.error.relative_l2; }},
    {"relmse", "relMSE", Unit::plain, [](const ComparisonRun& r) { return r.error.relmse; }},
    {"flip", "FLIP", Unit::plain, [](const ComparisonRun& r) { return r.error.flip; }},
};

// Without those that no run has: against a reference of single pixels there is no FLIP.
std::vector<Measure> measures_of(const Comparison& results) {
  std::vector<Measure> measures;
  for (const Measure& m : kMeasures)
    if (!std::all_of(results.runs.begin(), results.runs.end(),
                     [&](const ComparisonRun& run) { return std::isnan(m.value(run)); }))
      measures.push_back(m);
  return measures;
}

std::string tip_of(const ComparisonGroup& group, const std::vector<Measure>& measures) {
  const auto mean = [&](const Value& value) { return group.mean(value); };
  std::string tip = group.first().label + "\n" + show_seconds(mean([](const auto& r) { return r.seconds; })) +
                    " · " + show_count(mean([](const auto& r) { return r.rays; })) + " rays\n";
  for (const Measure& m : measures)
    tip += std::string(&m == measures.data() ? "" : " · ") + m.name + " " +
           (m.unit == Unit::percent ? show_percent(mean(m.value)) : show_number(mean(m.value)));
  if (group.runs.size() > 1) tip += "\nmean of " + std::to_string(group.runs.size()) + " seeds";
  return tip;
}

std::string error_plot(const Comparison& results, const ComparisonSummary& summary, const Measure& measure,
                       const std::vector<Measure>& measures, const PlotAxis& x, const Value& cost) {
  Plot plot;
  plot.title = std::string(measure.name) + " error against " + x.label;
  plot.x = x;
  plot.y = {std::string(measure.name) + " error", true, measure.unit};
  for (const std::string& name : summary.series) plot.series.push_back({name, {}, true});
  for (const ComparisonGroup& group : summary.groups)
    plot.series[group.series].points.push_back({group.mean(cost), group.mean(measure.value),
                                                group.lowest(measure.value), group.highest(measure.value),
                                                tip_of(group, measures)});
  if (measure.key == std::string("l1") && results.reference_error > 0)
    plot.guides.push_back({results.reference_error, "the reference's own error"});
  return svg_plot(plot);
}

}  // namespace

std::string error_section(const Comparison& results, const ComparisonSummary& summary) {
  if (results.runs.empty()) return {};
  const std::vector<Measure> measures = measures_of(results);
  std::string out =
      "<section class=\"errors\"><h2>Error against cost</h2>\n<p class=\"soft\">Lower and further left is "
      "better.";
  if (summary.max_seeds > 1)
    out += " Points are means over the seeds, bands reach from the lowest to the highest.";
  out +=
      " Click a name to hide its curve.</p>\n<div class=\"bar\"><div class=\"choice\" role=\"radiogroup\" "
      "aria-label=\"Measure of error\">";
  for (const Measure& m : measures)
    out += std::string("<label><input type=\"radio\" name=\"measure\" value=\"") + m.key + "\"" +
           (&m == measures.data() ? " checked=\"checked\"" : "") + "/><span>" + m.name + "</span></label>";
  out += "</div><div class=\"legend\">";
  for (std::size_t k = 0; k < summary.series.size(); ++k)
    out += "<button type=\"button\" aria-pressed=\"true\" data-key=\"" + std::to_string(k) + "\">" +
           svg_swatch(static_cast<int>(k)) + escape_html(summary.series[k]) + "</button>";
  out += "</div></div>\n";
  for (const Measure& m : measures) {
    out += std::string("<div class=\"plots") + (&m == measures.data() ? "" : " off") + "\" data-measure=\"" +
           m.key + "\">\n<figure><figcaption>Error against time</figcaption>" +
           error_plot(results, summary, m, measures, {"seconds of the method", true, Unit::seconds},
                      [](const ComparisonRun& r) { return r.seconds; }) +
           "</figure>\n<figure><figcaption>Error against rays</figcaption>" +
           error_plot(results, summary, m, measures, {"shadow rays", true, Unit::count},
                      [](const ComparisonRun& r) { return r.rays; }) +
           "</figure></div>\n";
  }
  return out + "</section>\n";
}

std::string singular_value_section(const Comparison& results) {
  const auto& values = results.singular_values;
  if (values.empty()) return {};
  // How many values hold all but 1 % of the matrix in the Frobenius norm: the tail is summed from its small
  // end.
  double total = 0, tail = 0;
  for (const double v : values) total += v * v;
  std::size_t rank = values.size();
  while (rank > 0 && tail + values[rank - 1] * values[rank - 1] <= 1e-4 * total) {
    tail += values[rank - 1] * values[rank - 1];
    --rank;
  }
  Plot plot;
  plot.title = "singular values";
  plot.x = {"number k", false, Unit::plain};
  plot.y = {"k-th over the largest singular value", true, Unit::plain};
  plot.series.push_back({"singular values", {}, false});
  const double max_value = *std::max_element(values.begin(), values.end());
  for (std::size_t k = 0; k < values.size(); ++k) {
    const double ratio = max_value > 0 ? values[k] / max_value : 0;
    // Below the rounding of the decomposition the curve says nothing, and would only flatten the rest.
    if (ratio > 1e-9) plot.series[0].points.push_back({static_cast<double>(k + 1), ratio, ratio, ratio, ""});
  }
  return "<section><h2>Singular values of the lighting matrix</h2>\n<p class=\"soft\">" +
         std::to_string(values.size()) + " values. The first " + std::to_string(rank) +
         " hold all but 1 % of the matrix (relative Frobenius norm): the rank that the methods live "
         "on.</p>\n<div "
         "class=\"plots\"><figure>" +
         svg_plot(plot) + "</figure></div></section>\n";
}

}  // namespace lumirank::pages
