// What a comparison found: plain data between the runs of the methods and the files that report them.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "image/metrics.h"

namespace lumirank::pages {

// One run of one method with one seed.
struct CompareRun {
  std::string method;
  std::string label;   // the method and the swept settings; the same for all seeds
  std::string series;  // the curve to which the run belongs
  std::map<std::string, std::string> settings;
  std::uint64_t seed = 0;
  double seconds = 0,
         setup_seconds = 0;  // of the method; and of what it stands on (receivers, lights, matrix)
  double rays = 0, entries = 0;
  image::ErrorMetrics error;
  double sampling_rate = 0;
  std::string image_file, error_image_file;  // PNG, relative to the folder of the page; empty: none
  std::map<std::string, double> phases;      // seconds
  std::map<std::string, double> numbers;     // all that the method's trace tells
};

struct CompareResults {
  std::string scene, reference_kind;
  double reference_error = 0;  // relative L1, as the reference itself states it
  double reference_seconds = 0;
  std::string reference_image;  // PNG, relative
  int width = 0, height = 0;
  std::vector<CompareRun> runs;
  std::vector<double> singular_values;  // descending; empty: not asked for
  std::string version;
  std::vector<std::string> notes;
  double error_full_scale = 0.5;  // error over the reference's mean at the yellow end of the error images
};

}  // namespace lumirank::pages
