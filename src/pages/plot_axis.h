// From numbers to places along one axis of a plot, and the ticks to write there.
#pragma once

#include <string>
#include <vector>

#include "pages/svg_plot.h"

namespace lumirank::pages {

struct Tick {
  double at = 0;     // place on the axis
  std::string text;  // empty: a thin line without a number
};

class Scale {
 public:
  Scale() = default;
  // Covers `values` (all positive if the axis is logarithmic) with some room; `from` and `to` are the places
  // of its ends.
  Scale(const PlotAxis& axis, const std::vector<double>& values, double from, double to);

  double operator()(double value) const;
  bool holds(double value) const;
  std::vector<Tick> ticks() const;

 private:
  std::vector<Tick> log_ticks() const;
  std::vector<Tick> linear_ticks() const;
  std::string show(double value) const;

  bool log_ = true;
  Unit unit_ = Unit::plain;
  double low_ = 0, high_ = 1;  // log10 of the ends if logarithmic
  double from_ = 0, to_ = 1;
};

}  // namespace lumirank::pages
