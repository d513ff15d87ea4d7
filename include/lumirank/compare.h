// Several methods on one scene against one reference, in one process.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "lumirank/export.h"
#include "lumirank/info.h"
#include "lumirank/lumirank.h"

namespace lumirank {

// What the runs are measured against.
struct ComparisonReference {
  enum class Kind {
    path,         // path tracing of the paths that columns carry
    brute_force,  // the sum of all columns of the matrix, which all runs sample then
    receivers,    // the same at some receivers alone, of stratified pixels: for pictures of full size
    file,         // an image of the render's size
  };
  Kind kind = Kind::path;
  double seconds = 60;        // of path tracing
  std::size_t receivers = 0;  // of Kind::receivers, at least 64
  std::string file;
};

// Several values of one parameter, or of some together: a run with each.
struct ComparisonSweep {
  std::string method;             // whose parameters they are; "": "lights" or "spp", of all methods
  std::vector<std::string> keys;  // as in MethodParameter::key
  std::vector<std::vector<std::string>> values;  // of each run, one for every key
};

// By what the runs are paired that the report names beside each other.
enum class EqualCost { none, time, rays, error };

struct CompareSettings {
  RenderSettings base;
  std::vector<std::string> methods;
  ComparisonReference reference;
  std::vector<double> times;  // seconds: a run with each as its budget
  std::vector<ComparisonSweep> sweeps;
  int seeds = 1;                 // runs of each kind, with seeds from base.seed on
  bool singular_values = false;  // also those of a small matrix (2007, Figure 3)
  EqualCost equal = EqualCost::none;
};

// One run of one method with one seed.
struct ComparisonRun {
  std::string method;
  std::string label;   // the method and the swept settings; the same for all seeds
  std::string series;  // the curve to which the run belongs
  std::map<std::string, std::string> settings;
  std::uint64_t seed = 0;
  double seconds = 0;        // of the method
  double setup_seconds = 0;  // of what it stands on: receivers, lights, matrix
  double rays = 0, entries = 0;
  PictureError error;
  double sampling_rate = 0;                  // entries over those of the whole matrix
  std::string image_file, error_image_file;  // PNG, in the folder; "": none
  std::map<std::string, double> phases;      // seconds
  std::map<std::string, double> numbers;  // what the method says of its run, by the keys of Report::numbers
};

struct Comparison {
  std::string scene, version;
  std::string reference_kind;  // in words
  double reference_error = 0;  // relative L1, as the reference itself states it
  double reference_seconds = 0;
  std::string reference_image;  // PNG, in the folder
  int width = 0, height = 0;
  std::vector<ComparisonRun> runs;
  std::vector<double> singular_values;  // descending; empty: not asked for
  std::vector<std::string> notes;
  double error_full_scale = 0.5;  // error over the reference's mean at the yellow end of the error images
  bool interrupted = false;       // cancelled: `runs` are those that were finished
};

// Writes results.json, results.csv, images, error images and index.html into `folder` (made if absent), also
// what has been finished when `sinks.cancel` is set. Throws InputError for what cannot be compared, before
// any work where that can be known.
LUMIRANK_API Comparison compare(const Scene& scene, const CompareSettings& settings,
                                const std::string& folder, const Sinks& sinks = {});

}  // namespace lumirank
