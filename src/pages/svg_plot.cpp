#include "pages/svg_plot.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

#include "pages/html_text.h"
#include "pages/plot_axis.h"

namespace lumirank::pages {
namespace {

constexpr double kWidth = 600, kHeight = 400, kLeft = 84, kRight = 18, kTop = 14, kBottom = 52;

std::string coordinate(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.2f", value);
  return text;
}

std::string series_class(std::size_t k) { return "series s" + std::to_string(k % kPlotColors); }

// Colors repeat after eight; the marks then differ.
std::string marker(std::size_t series, double x, double y, const std::string& tip) {
  const std::string label = tip.empty() ? "" : "<title>" + escape_html(tip) + "</title>";
  const auto at = [&](double dx, double dy) { return coordinate(x + dx) + "," + coordinate(y + dy) + " "; };
  switch ((series + series / kPlotColors) % 4) {
    case 0:
      return "<circle class=\"mark\" cx=\"" + coordinate(x) + "\" cy=\"" + coordinate(y) + "\" r=\"4.2\">" +
             label + "</circle>";
    case 1:
      return "<polygon class=\"mark\" points=\"" + at(-3.9, -3.9) + at(3.9, -3.9) + at(3.9, 3.9) +
             at(-3.9, 3.9) + "\">" + label + "</polygon>";
    case 2:
      return "<polygon class=\"mark\" points=\"" + at(0, -5.2) + at(4.8, 3.6) + at(-4.8, 3.6) + "\">" +
             label + "</polygon>";
    default:
      return "<polygon class=\"mark\" points=\"" + at(0, -5.6) + at(5.6, 0) + at(0, 5.6) + at(-5.6, 0) +
             "\">" + label + "</polygon>";
  }
}

// Numbers side by side that do not touch: 1, 10, 100, … before 2 and 5 and these before the others.
std::vector<Tick> without_overlaps(std::vector<Tick> ticks) {
  constexpr double kDigit = 10, kGap = 8;  // also in the larger type of narrow pages
  const auto rank = [](const Tick& tick) {
    const auto first = tick.text.find_first_of("123456789");
    if (first == std::string::npos || tick.text[first] == '1') return 0;
    return tick.text[first] == '2' || tick.text[first] == '5' ? 1 : 2;
  };
  std::erase_if(ticks, [](const Tick& tick) { return tick.text.empty(); });
  std::stable_sort(ticks.begin(), ticks.end(),
                   [&](const Tick& a, const Tick& b) { return rank(a) < rank(b); });
  std::vector<Tick> kept;
  for (const Tick& tick : ticks)
    if (std::none_of(kept.begin(), kept.end(), [&](const Tick& other) {
          const double room = kDigit / 2 * static_cast<double>(tick.text.size() + other.text.size()) + kGap;
          return std::abs(tick.at - other.at) < room;
        }))
      kept.push_back(tick);
  return kept;
}

class Drawing {
 public:
  explicit Drawing(const Plot& plot) : plot_(plot) {
    collect();
    x_ = Scale(plot.x, xs_, kLeft, kWidth - kRight);
    for (const PlotGuide& guide : plot.guides)
      // A guide far below the curves would only squeeze them together.
      if (!ys_.empty() && guide.y > 0 && guide.y > *std::min_element(ys_.begin(), ys_.end()) / 10)
        ys_.push_back(guide.y);
    y_ = Scale(plot.y, ys_, kHeight - kBottom, kTop);
  }

  std::string draw() {
    out_ = "<svg class=\"plot\" xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 " + coordinate(kWidth) +
           " " + coordinate(kHeight) + "\" role=\"img\" aria-label=\"" + escape_html(plot_.title) + "\">\n";
    draw_axes();
    if (xs_.empty()) {
      text((kLeft + kWidth - kRight) / 2, (kTop + kHeight - kBottom) / 2, "middle", "empty",
           "nothing to show");
    } else {
      for (const PlotGuide& guide : plot_.guides) draw_guide(guide);
      // All bands lie under all lines.
      for (std::size_t k = 0; k < shown_.size(); ++k) draw_band(k);
      for (std::size_t k = 0; k < shown_.size(); ++k) draw_series(k);
    }
    if (left_out_ > 0)
      text(kWidth - kRight - 6, kHeight - kBottom - 8, "end", "remark",
           std::to_string(left_out_) + (left_out_ == 1 ? " point has" : " points have") +
               " no place on these axes (zero or not finite)");
    return out_ + "</svg>\n";
  }

 private:
  void collect() {
    for (const PlotSeries& series : plot_.series) {
      std::vector<PlotPoint> points;
      for (const PlotPoint& p : series.points) {
        const bool fits = std::isfinite(p.x) && std::isfinite(p.y) && (p.x > 0 || !plot_.x.log) &&
                          (p.y > 0 || !plot_.y.log);
        left_out_ += !fits;
        if (!fits) continue;
        points.push_back(p);
        PlotPoint& kept = points.back();
        if (!(std::isfinite(p.low) && std::isfinite(p.high) && p.low <= p.y && p.y <= p.high &&
              (p.low > 0 || !plot_.y.log)))
          kept.low = kept.high = kept.y;
        xs_.push_back(kept.x);
        ys_.insert(ys_.end(), {kept.low, kept.high});
      }
      std::stable_sort(points.begin(), points.end(),
                       [](const PlotPoint& a, const PlotPoint& b) { return a.x < b.x; });
      shown_.push_back(std::move(points));
    }
  }

  void text(double x, double y, const char* anchor, const char* css_class, const std::string& words,
            const std::string& more = {}) {
    out_ += "<text class=\"" + std::string(css_class) + "\" x=\"" + coordinate(x) + "\" y=\"" +
            coordinate(y) + "\" text-anchor=\"" + anchor + "\"" + more + ">" + escape_html(words) +
            "</text>\n";
  }

  void line(const char* css_class, double x1, double y1, double x2, double y2) {
    out_ += "<line class=\"" + std::string(css_class) + "\" x1=\"" + coordinate(x1) + "\" y1=\"" +
            coordinate(y1) + "\" x2=\"" + coordinate(x2) + "\" y2=\"" + coordinate(y2) + "\"/>\n";
  }

  void draw_axes() {
    const double right = kWidth - kRight, bottom = kHeight - kBottom;
    std::vector<Tick> ticks = x_.ticks();
    for (const Tick& tick : ticks)
      line(tick.text.empty() ? "grid minor" : "grid", tick.at, kTop, tick.at, bottom);
    for (const Tick& tick : without_overlaps(std::move(ticks)))
      text(tick.at, bottom + 18, "middle", "tick", tick.text);
    for (const Tick& tick : y_.ticks()) {
      line(tick.text.empty() ? "grid minor" : "grid", kLeft, tick.at, right, tick.at);
      if (!tick.text.empty()) text(kLeft - 8, tick.at + 4, "end", "tick", tick.text);
    }
    out_ += "<rect class=\"frame\" x=\"" + coordinate(kLeft) + "\" y=\"" + coordinate(kTop) + "\" width=\"" +
            coordinate(right - kLeft) + "\" height=\"" + coordinate(bottom - kTop) + "\"/>\n";
    text((kLeft + right) / 2, kHeight - 10, "middle", "axis", plot_.x.label);
    const std::string middle = coordinate((kTop + bottom) / 2);
    text(16, (kTop + bottom) / 2, "middle", "axis", plot_.y.label,
         " transform=\"rotate(-90 16 " + middle + ")\"");
  }

  void draw_guide(const PlotGuide& guide) {
    if (!y_.holds(guide.y)) return;
    const double y = y_(guide.y);
    line("guide", kLeft, y, kWidth - kRight, y);
    text(kLeft + 6, y - 5, "start", "remark", guide.label);
  }

  void draw_band(std::size_t k) {
    const auto& points = shown_[k];
    if (std::none_of(points.begin(), points.end(), [](const PlotPoint& p) { return p.low < p.high; })) return;
    out_ += "<g class=\"" + series_class(k) + "\" data-series=\"" + std::to_string(k) + "\">";
    if (points.size() == 1) {
      line("whisker", x_(points[0].x), y_(points[0].low), x_(points[0].x), y_(points[0].high));
    } else {
      out_ += "<polygon class=\"band\" points=\"";
      for (const PlotPoint& p : points) out_ += coordinate(x_(p.x)) + "," + coordinate(y_(p.high)) + " ";
      for (auto p = points.rbegin(); p != points.rend(); ++p)
        out_ += coordinate(x_(p->x)) + "," + coordinate(y_(p->low)) + " ";
      out_ += "\"/>";
    }
    out_ += "</g>\n";
  }

  void draw_series(std::size_t k) {
    const auto& points = shown_[k];
    if (points.empty()) return;
    out_ += "<g class=\"" + series_class(k) + "\" data-series=\"" + std::to_string(k) + "\">";
    if (points.size() > 1) {
      out_ += "<polyline class=\"line\" points=\"";
      for (const PlotPoint& p : points) out_ += coordinate(x_(p.x)) + "," + coordinate(y_(p.y)) + " ";
      out_ += "\"/>";
    }
    if (plot_.series[k].markers)
      for (const PlotPoint& p : points) out_ += marker(k, x_(p.x), y_(p.y), p.tip);
    out_ += "</g>\n";
  }

  const Plot& plot_;
  std::vector<std::vector<PlotPoint>> shown_;
  std::vector<double> xs_, ys_;
  int left_out_ = 0;
  Scale x_, y_;
  std::string out_;
};

}  // namespace

std::string svg_plot(const Plot& plot) { return Drawing(plot).draw(); }

std::string svg_swatch(int series) {
  const auto k = static_cast<std::size_t>(series);
  return "<svg class=\"swatch\" xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 26 14\" "
         "aria-hidden=\"true\"><g class=\"" +
         series_class(k) + "\"><polyline class=\"line\" points=\"1,7 25,7\"/>" + marker(k, 13, 7, "") +
         "</g></svg>";
}

}  // namespace lumirank::pages
