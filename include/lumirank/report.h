// Reports of renders and references: typed values, and the same as flat JSON with stable keys.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "lumirank/export.h"
#include "lumirank/settings.h"

namespace lumirank {

struct LUMIRANK_API Report {
  std::string method, version;
  std::uint64_t seed = 0;
  std::map<std::string, double> seconds;  // wall clock by stage; "total" from the loaded scene on

  // Of the matrix: what the method evaluated.
  struct Cost {
    std::uint64_t entries = 0;  // evaluated, zero or not
    std::uint64_t culled = 0;   // of these, decided without a ray
    std::uint64_t shadow_rays = 0;
    double sampling_rate = 0;  // share of all entries, or as the method itself counts
  };
  std::optional<Cost> cost = {};

  struct Sizes {
    std::uint64_t pixels = 0, receivers = 0, lights = 0;
    std::uint64_t lights_asked = 0, direct_lights = 0, light_paths = 0;
  };
  std::optional<Sizes> sizes = {};

  // Bytes.
  struct Memory {
    std::uint64_t peak = 0;  // of the process
    std::uint64_t scene = 0, receivers = 0, lights = 0, matrix = 0;
  };
  Memory memory;

  // All else, by the keys of the JSON: what the method's trace tells ("rows", "error.estimate", …).
  std::map<std::string, double> numbers;
  std::map<std::string, std::string> notes;

  // Relative L1 error as the render states it; empty where it states none.
  std::optional<double> stated_error() const;

  RenderSettings settings;                                   // as asked
  std::map<std::string, std::vector<std::int64_t>> choices;  // of the clock, under a time budget

  // One object: "seconds.total", "entries.evaluated", … and "parameters".
  std::string json() const;
};

}  // namespace lumirank
