// "Did you mean …?"
#pragma once

#include <string>
#include <string_view>

namespace lumirank::scenedesc {

// Number of letters to insert, remove or change (Levenshtein).
std::size_t edit_distance(std::string_view a, std::string_view b);

// The one of `names` that is closest to `written` and at most two letters away; "" if there is none.
template <typename Names>
std::string close_name(const std::string& written, const Names& names) {
  std::string close;
  std::size_t best = 3;
  if (written.size() > 100) return close;
  for (const auto& entry : names) {
    if (const std::size_t distance = edit_distance(written, entry); distance < best)
      best = distance, close = entry;
  }
  return close;
}

}  // namespace lumirank::scenedesc
