// Choices that the clock made under a time budget: how many rows were read, how many columns rendered,
// whether more rows paid. A run writes these choices down; one that is given an earlier run's repeats them
// and asks no clock, so that it ends with the same bits.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "methods/method.h"

namespace lumirank::methods {

class TimedChoices {
 public:
  using Lists = std::map<std::string, std::vector<std::int64_t>>;  // by decision, in the order of the run

  TimedChoices() = default;              // writes down
  explicit TimedChoices(Lists earlier);  // repeats

  // The earlier run's next choice; nothing if the clock is to be asked. Throws InputError if there is none
  // left, or if it does not lie in 0 … most: the choices belong to another scene or other settings.
  std::optional<std::int64_t> earlier(const std::string& what, std::int64_t max_value);
  void record(const std::string& what, std::int64_t value) { made_[what].push_back(value); }
  // A number that must be what it was in the earlier run. Throws InputError if it is not.
  void expect(const std::string& what, std::int64_t value);
  // Throws InputError if the earlier run went on.
  void expect_end() const;
  const Lists& made() const { return made_; }

 private:
  bool repeats_ = false;
  Lists earlier_, made_;
};

// Without a budget, or where nobody keeps the choices, the clock alone decides.
inline TimedChoices* choices_of(const RunOptions& options) {
  return options.time_seconds > 0 ? options.choices : nullptr;
}
// A choice that `measure` makes, once: a count, or 0 or 1.
template <typename Measure>
auto timed_choice(const RunOptions& options, const char* what, std::int64_t max_value, Measure&& measure) {
  using Value = decltype(measure());
  TimedChoices* choices = choices_of(options);
  if (!choices) return measure();
  const auto before = choices->earlier(what, max_value);
  const Value value = before ? static_cast<Value>(*before) : measure();
  choices->record(what, static_cast<std::int64_t>(value));
  return value;
}

}  // namespace lumirank::methods
