#include "methods/common/timed_choices.h"

#include <algorithm>

#include "base/error.h"

namespace lumirank::methods {

namespace {
[[noreturn]] void does_not_fit(const std::string& how) {
  throw InputError("the replayed choices of a timed run do not fit: " + how,
                   "replay with the scene and the settings of the report, or give --time to choose anew");
}
}  // namespace

TimedChoices::TimedChoices(Lists earlier) : repeats_(true), earlier_(std::move(earlier)) {
  // Taken from the back.
  for (auto& [what, values] : earlier_) std::reverse(values.begin(), values.end());
}

std::optional<std::int64_t> TimedChoices::earlier(const std::string& what, std::int64_t max_value) {
  if (!repeats_) return std::nullopt;
  const auto found = earlier_.find(what);
  if (found == earlier_.end()) does_not_fit("they lack '" + what + "'");
  if (found->second.empty()) does_not_fit("there are too few of '" + what + "'");
  const std::int64_t value = found->second.back();
  found->second.pop_back();
  if (value < 0 || value > max_value)
    does_not_fit("'" + what + "' is " + std::to_string(value) + ", and at most " + std::to_string(max_value) +
                 " is possible");
  return value;
}

void TimedChoices::expect(const std::string& what, std::int64_t value) {
  const auto before = earlier(what, INT64_MAX);
  if (before && *before != value)
    does_not_fit("'" + what + "' was " + std::to_string(*before) + " and is " + std::to_string(value));
  record(what, value);
}

void TimedChoices::expect_end() const {
  for (const auto& [what, values] : earlier_)
    if (!values.empty()) does_not_fit("there are too many of '" + what + "'");
}

}  // namespace lumirank::methods
