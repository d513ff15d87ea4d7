// What the fuzz targets of scene formats do with their bytes.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>

#include "scenedesc/readers.h"

namespace lumirank::fuzz {

// Reads them as they stand and at a moment. Only InputError may come out.
template <typename Parse>
void read_scene(const std::uint8_t* data, std::size_t size, const char* name, const Parse& parse) {
  const std::string bytes(reinterpret_cast<const char*>(data), size);
  for (const std::optional<double> time : {std::optional<double>(), std::optional<double>(0.4)}) {
    try {
      scenedesc::ReadOptions options;
      options.time = time;
      if (time) options.clip = "*";
      (void)scenedesc::describe(parse(bytes, name, options));
    } catch (const InputError&) {
    }
  }
}

}  // namespace lumirank::fuzz
