// Several methods on one scene against one reference, in one process.
#pragma once

#include <string>
#include <vector>

#include "lumirank/export.h"
#include "lumirank/lumirank.h"

namespace lumirank {

struct CompareSettings {
  RenderSettings base;
  std::vector<std::string> methods;
  std::string reference =
      "path";  // a file, "path", "brute-force", or "brute-force:N" (all columns at N receivers)
  double reference_time = 60;  // seconds for "path"
  std::vector<double> times;   // --times: one run per budget
  // --sweep KEY=V1,V2 with KEY a parameter METHOD.KEY, "lights" or "spp"; METHOD.a:b=1:2,3:4 sweeps two
  // together.
  struct Sweep {
    std::string key;
    std::vector<std::string> values;
  };
  std::vector<Sweep> sweeps;
  int seeds = 1;
  bool singular_values = false;
  std::string equal;  // "", "time", "rays", "error"
};

// Writes results.json, results.csv, images, error images and index.html into `folder` (made if absent). What
// has been finished when `sinks.cancel` is set is written; returns false then.
LUMIRANK_API bool compare(const Scene& scene, const CompareSettings& settings, const std::string& folder,
                          const Sinks& sinks = {});

}  // namespace lumirank
