// A description, written as Mitsuba 3 XML, read and written again.
#pragma once

#include <fstream>
#include <regex>
#include <string>

#include "scenedesc/readers.h"
#include "scenedesc/writer/mitsuba_writer.h"
#include "support/scene_file.h"

namespace lumirank::scenedesc {

// The listing without the head and made-up names.
inline std::string listing(const SceneDesc& scene) {
  std::string text = describe(scene);
  text.erase(0, text.find(", depth"));
  text.erase(text.rfind('\n'));
  return std::regex_replace(text, std::regex("\n  ([0-9]+) \"[^\"]*\":"), "\n  $1:");
}

struct RoundTrip {
  WrittenScene first, second;
  SceneDesc again;
  RoundTrip(const SceneDesc& scene, const test::TemporaryFolder& folder) {
    const std::string name = folder / "out.xml";
    first = write_mitsuba(scene, name);
    for (const WrittenFile& file : first.files)
      std::ofstream(folder / file.name, std::ios::binary) << file.bytes;
    again = parse_mitsuba(first.xml, name);
    second = write_mitsuba(again, name);
  }
};

}  // namespace lumirank::scenedesc
