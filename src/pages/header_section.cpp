#include <cmath>

#include "pages/html_text.h"
#include "pages/sections.h"

namespace lumirank::pages {
namespace {

std::string fact(const std::string& term, const std::string& value) {
  return "<div><dt>" + escape_html(term) + "</dt><dd>" + escape_html(value) + "</dd></div>\n";
}

// A reference serves for errors of at least five times its own.
std::string reference_warning(const Comparison& results, const ComparisonSummary& summary) {
  if (!(results.reference_error > 0)) return {};
  std::size_t doubtful = 0;
  for (const ComparisonGroup& group : summary.groups)
    doubtful +=
        group.mean([](const ComparisonRun& r) { return r.error.relative_l1; }) < 5 * results.reference_error;
  if (doubtful == 0) return {};
  return "<p class=\"warn\">The reference's own error is more than a fifth of the relative L1 error of " +
         std::to_string(doubtful) + " of " + std::to_string(summary.groups.size()) +
         " settings, so its own noise weighs in those numbers.</p>\n";
}

}  // namespace

std::string header_section(const Comparison& results, const ComparisonSummary& summary) {
  double rays = 0, entries = 0;
  for (const ComparisonRun& run : results.runs) rays += run.rays, entries += run.entries;
  const bool exact = results.reference_kind.starts_with("all ");  // columns
  const std::string own_error = exact ? "none: the exact sums of the same lights"
                                : results.reference_error > 0
                                    ? show_percent(results.reference_error) + " (relative L1)"
                                    : "not stated";
  std::string out =
      "<header><h1>" + escape_html(results.scene) + "</h1>\n<p class=\"soft\">" +
      std::to_string(summary.series.size()) + (summary.series.size() == 1 ? " curve, " : " curves, ") +
      std::to_string(summary.groups.size()) + " settings, " + std::to_string(results.runs.size()) + " runs" +
      (summary.max_seeds > 1 ? ", up to " + std::to_string(summary.max_seeds) + " seeds each" : "") +
      ". Rays, entries and errors are facts of the methods; seconds are of this machine.</p>\n<dl "
      "class=\"facts\">";
  out += fact("Image", std::to_string(results.width) + " × " + std::to_string(results.height) + " pixels");
  out += fact("Reference", results.reference_kind);
  out += fact("Reference's own error", own_error);
  if (results.reference_seconds > 0)
    out += fact("Time of the reference", show_seconds(results.reference_seconds));
  out += fact("Shadow rays, all runs", show_count(rays));
  out += fact("Matrix entries, all runs", show_count(entries));
  out += "</dl>\n" + reference_warning(results, summary);
  if (!results.notes.empty()) {
    out += "<ul class=\"notes\">";
    for (const std::string& note : results.notes) out += "<li>" + escape_html(note) + "</li>";
    out += "</ul>\n";
  }
  return out + "</header>\n";
}

}  // namespace lumirank::pages
