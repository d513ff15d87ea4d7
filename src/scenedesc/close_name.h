// "Did you mean …?"
#pragma once

#include <string>

namespace lumirank::scenedesc {

// Number of letters to insert, remove or change (Levenshtein).
std::size_t edit_distance(const std::string& a, const std::string& b);

// The one of `names` that is closest to `written` and at most two letters away; "" if there is none.
template <typename Names>
std::string close_name(const std::string& written, const Names& names) {
  std::string close;
  std::size_t best = 3;
  if (written.size() > 100) return close;
  for (const auto& entry : names) {
    const std::string name(entry);
    if (const std::size_t distance = edit_distance(written, name); distance < best)
      best = distance, close = name;
  }
  return close;
}

}  // namespace lumirank::scenedesc
