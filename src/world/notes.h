// Notes of the builders: what they had to replace or mend.
#pragma once

#include <string>
#include <vector>

#include "base/error.h"
#include "scenedesc/schema/scene_desc.h"

namespace lumirank::world {

class Notes {
 public:
  Notes(std::vector<scenedesc::Warning>& out, bool strict) : out_(out), strict_(strict) {}

  // `instead` says what happens in place of it; "" if it is left out. Throws InputError if warnings are
  // errors.
  void warn(const SourceLocation& where, const std::string& what, const std::string& instead) {
    if (strict_)
      throw InputError(where, what,
                       "--strict is given; without it: " + (instead.empty() ? "left out" : instead));
    out_.push_back({where, what, instead, false});
  }
  // For what no picture can show.
  void note(const SourceLocation& where, const std::string& what) { out_.push_back({where, what, "", true}); }

 private:
  std::vector<scenedesc::Warning>& out_;
  bool strict_;
};

}  // namespace lumirank::world
