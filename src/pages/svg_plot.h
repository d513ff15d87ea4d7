// Line plots as SVG text. Colors and fonts come from the page's style sheet, by class: series k is in class
// "s<k mod 8>".
#pragma once

#include <string>
#include <vector>

namespace lumirank::pages {

struct PlotPoint {
  double x = 0, y = 0;
  double low = 0, high = 0;  // the band over the seeds; equal: none
  std::string tip;           // shown while the pointer is over the point
};

struct PlotSeries {
  std::string name;
  std::vector<PlotPoint> points;
  bool markers = true;
};

enum class Unit { plain, seconds, count, percent };

struct PlotAxis {
  std::string label;
  bool log = true;
  Unit unit = Unit::plain;
};

struct PlotGuide {  // a horizontal line
  double y = 0;
  std::string label;
};

struct Plot {
  std::string title;  // read out by screen readers
  PlotAxis x, y;
  std::vector<PlotSeries> series;
  std::vector<PlotGuide> guides;
};

inline constexpr int kPlotColors = 8;

// One <svg> element. Points that a log axis cannot hold (not positive) or that are not finite are left out,
// and a line of text in the plot says how many. Series without points take no room but keep their color.
std::string svg_plot(const Plot& plot);

// The mark of series k as an <svg> of its own, for a legend.
std::string svg_swatch(int series);

}  // namespace lumirank::pages
