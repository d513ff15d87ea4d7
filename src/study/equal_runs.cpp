#include "study/equal_runs.h"

#include <cmath>

#include "pages/html_text.h"

namespace lumirank::study {

using pages::CompareRun;

std::vector<std::string> runs_at_equal(const std::string& equal, const std::vector<std::string>& methods,
                                       const std::vector<CompareRun>& runs) {
  if (equal.empty() || runs.empty()) return {};
  const auto cost = [&](const CompareRun& r) {
    if (equal == "time") return r.seconds;
    return equal == "rays" ? r.rays : r.error.relative_l2;
  };
  const CompareRun* anchor = nullptr;
  for (const auto& r : runs)
    if (r.method == methods.front() && (!anchor || r.error.relative_l2 < anchor->error.relative_l2))
      anchor = &r;
  if (!anchor) return {};
  std::vector<std::string> lines{"At equal " + equal + " to " + anchor->label + ":"};
  for (const auto& method : methods) {
    const CompareRun* nearest = nullptr;
    for (const auto& r : runs)
      if (r.method == method && (!nearest || std::abs(std::log(cost(r) / cost(*anchor))) <
                                                 std::abs(std::log(cost(*nearest) / cost(*anchor)))))
        nearest = &r;
    if (nearest)
      lines.push_back(nearest->label + ": " + pages::show_seconds(nearest->seconds) + ", " +
                      pages::show_count(nearest->rays) + " rays, relative L2 " +
                      pages::show_percent(nearest->error.relative_l2));
  }
  return lines;
}

}  // namespace lumirank::study
