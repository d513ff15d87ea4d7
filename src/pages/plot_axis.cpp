#include "pages/plot_axis.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace lumirank::pages {
namespace {

// The shortest form of a round number; small and large powers of ten as such.
std::string plain(double value) {
  char text[32];
  const double power = value > 0 ? std::log10(value) : 0, whole = std::round(power);
  if (std::abs(whole) >= 4 && std::abs(power - whole) < 1e-9) {
    static const char* const digits[] = {"⁰", "¹", "²", "³", "⁴", "⁵", "⁶", "⁷", "⁸", "⁹"};
    std::string raised = "10";
    if (whole < 0) raised += "⁻";
    for (const char c : std::to_string(std::abs(static_cast<int>(whole)))) raised += digits[c - '0'];
    return raised;
  }
  std::snprintf(text, sizeof text, "%.4g", value);
  return text;
}

std::string with_prefix(double value) {
  const char* const units[] = {"", "k", "M", "G", "T", "P"};
  char text[32];
  int unit = 0;
  while (std::abs(value) >= 999.999 && unit < 5) value /= 1000, ++unit;
  std::snprintf(text, sizeof text, "%.4g%s", value, units[unit]);
  return text;
}

}  // namespace

Scale::Scale(const PlotAxis& axis, const std::vector<double>& values, double from, double to)
    : log_(axis.log), unit_(axis.unit), from_(from), to_(to) {
  if (values.empty()) return;
  const auto [smallest, largest] = std::minmax_element(values.begin(), values.end());
  low_ = log_ ? std::log10(*smallest) : *smallest;
  high_ = log_ ? std::log10(*largest) : *largest;
  // At least a factor of two (or a unit) is shown, so that one point alone lies in the middle.
  const double min_spread = log_ ? 0.6 : std::max(1e-12, 1e-3 * std::abs(high_));
  const double spread = std::max(high_ - low_, min_spread), middle = (low_ + high_) / 2;
  low_ = middle - 0.55 * spread, high_ = middle + 0.55 * spread;
  if (!log_ && *smallest >= 0 && low_ < 0) low_ = 0;
}

double Scale::operator()(double value) const {
  const double v = log_ ? std::log10(value) : value;
  return from_ + (to_ - from_) * (v - low_) / (high_ - low_);
}

bool Scale::holds(double value) const {
  if (log_ && !(value > 0)) return false;
  const double v = log_ ? std::log10(value) : value;
  return v >= low_ && v <= high_;
}

std::string Scale::show(double value) const {
  switch (unit_) {
    case Unit::count:
      return with_prefix(value);
    case Unit::percent:
      return plain(100 * value) + " %";
    case Unit::seconds:
    case Unit::plain:
      break;
  }
  return plain(value);
}

std::vector<Tick> Scale::ticks() const { return log_ ? log_ticks() : linear_ticks(); }

std::vector<Tick> Scale::log_ticks() const {
  std::vector<Tick> ticks;
  const double decades = high_ - low_;
  // Few decades: 1, 2 and 5 carry numbers; many: every one, or every second, … power of ten.
  const int stride = std::max(1, static_cast<int>(std::ceil(decades / 8)));
  for (int power = static_cast<int>(std::floor(low_)); power <= static_cast<int>(std::ceil(high_)); ++power)
    for (int digit = 1; digit <= 9; ++digit) {
      const double value = std::pow(10.0, power) * digit;
      if (!holds(value)) continue;
      const bool numbered = digit == 1       ? power % stride == 0
                            : decades <= 0.8 ? true
                            : decades <= 3   ? digit == 2 || digit == 5
                                             : false;
      if (numbered || decades <= 5) ticks.push_back({(*this)(value), numbered ? show(value) : ""});
    }
  return ticks;
}

std::vector<Tick> Scale::linear_ticks() const {
  std::vector<Tick> ticks;
  const double rough = (high_ - low_) / 6, power = std::pow(10.0, std::floor(std::log10(rough)));
  const double step = rough / power < 1.5   ? power
                      : rough / power < 3.5 ? 2 * power
                      : rough / power < 7.5 ? 5 * power
                                            : 10 * power;
  for (double k = std::ceil(low_ / step); k * step <= high_; ++k)
    ticks.push_back({(*this)(k * step), show(k * step)});
  return ticks;
}

}  // namespace lumirank::pages
