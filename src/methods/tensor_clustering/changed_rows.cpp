#include "methods/tensor_clustering/changed_rows.h"

#include <algorithm>
#include <cstdint>
#include <set>
#include <utility>

namespace lumirank::methods {
namespace {

using matrix::Index;

constexpr int kLargestSquare = 8;  // pixels

enum class Answer : std::uint8_t { unknown, same, changed };

class ChangeSearch {
 public:
  ChangeSearch(std::span<const Vec2f> pixel, std::size_t rows) : answers_(rows, Answer::unknown) {
    for (const Vec2f p : pixel)
      width_ = std::max(width_, static_cast<int>(p.x) + 1),
      height_ = std::max(height_, static_cast<int>(p.y) + 1);
    if (pixel.empty()) width_ = static_cast<int>(rows);
    first_.assign(static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_) + 1, 0);
    const auto at = [&](std::size_t i) {
      return pixel.empty() ? i
                           : index(std::max(0, static_cast<int>(pixel[i].x)),
                                   std::max(0, static_cast<int>(pixel[i].y)));
    };
    for (std::size_t i = 0; i < rows; ++i) ++first_[at(i) + 1];
    for (std::size_t p = 1; p < first_.size(); ++p) first_[p] += first_[p - 1];
    std::vector<std::uint32_t> filled(first_.begin(), first_.end() - 1);
    of_pixel_.resize(rows);
    for (std::size_t i = 0; i < rows; ++i) of_pixel_[filled[at(i)]++] = static_cast<Index>(i);
  }

  std::vector<Index> run(const HasChanged& has_changed) {
    std::set<Square> open;
    for (int y = 0; y < height_; y += kLargestSquare)
      for (int x = 0; x < width_; x += kLargestSquare) open.insert({y / kLargestSquare, x / kLargestSquare});
    for (int size = kLargestSquare; size >= 1 && !open.empty(); size /= 2) {
      std::vector<Index> wanted;
      for (const Square& s : open)
        if (const int row = unasked_of(s, size); row >= 0) wanted.push_back(static_cast<Index>(row));
      ask(std::move(wanted), has_changed);
      std::set<Square> next;
      for (const Square& s : open)
        if (changed(s, size)) open_around(s, size, next);
      open = std::move(next);
    }
    // What is left open are single pixels: all that they show.
    std::vector<Index> rest;
    for (const auto& [y, x] : open)
      for (const Index row : rows_at(x, y))
        if (answers_[row] == Answer::unknown) rest.push_back(row);
    ask(std::move(rest), has_changed);
    return std::move(asked_);
  }

 private:
  using Square = std::pair<int, int>;  // y, x, in its own size

  std::size_t index(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(x);
  }
  std::span<const Index> rows_at(int x, int y) const {
    const std::size_t p = index(x, y);
    return std::span(of_pixel_).subspan(first_[p], first_[p + 1] - first_[p]);
  }
  template <typename Body>
  void each_pixel(const Square& s, int size, const Body& body) const {
    for (int y = s.first * size; y < std::min(height_, (s.first + 1) * size); ++y)
      for (int x = s.second * size; x < std::min(width_, (s.second + 1) * size); ++x) body(x, y);
  }

  // The row nearest to its middle; -1 if one of the square has been asked, or there are none.
  int unasked_of(const Square& s, int size) const {
    int best = -1, least = 0;
    bool asked = false;
    each_pixel(s, size, [&](int x, int y) {
      for (const Index row : rows_at(x, y)) {
        asked = asked || answers_[row] != Answer::unknown;
        const int dx = 2 * (x - s.second * size) + 1 - size, dy = 2 * (y - s.first * size) + 1 - size;
        if (best < 0 || dx * dx + dy * dy < least) best = static_cast<int>(row), least = dx * dx + dy * dy;
      }
    });
    return asked ? -1 : best;
  }
  bool changed(const Square& s, int size) const {
    bool any = false;
    each_pixel(s, size, [&](int x, int y) {
      for (const Index row : rows_at(x, y)) any = any || answers_[row] == Answer::changed;
    });
    return any;
  }
  // Its parts and those of its neighbors that touch it; single pixels have no parts but themselves.
  void open_around(const Square& s, int size, std::set<Square>& next) const {
    const int parts = size > 1 ? 2 : 1, part = size > 1 ? size / 2 : 1;
    for (int y = parts * s.first - 1; y <= parts * s.first + parts; ++y)
      for (int x = parts * s.second - 1; x <= parts * s.second + parts; ++x)
        if (y >= 0 && x >= 0 && y * part < height_ && x * part < width_) next.insert({y, x});
  }
  void ask(std::vector<Index> rows, const HasChanged& has_changed) {
    if (rows.empty()) return;
    std::sort(rows.begin(), rows.end());  // neighbors by number may be cheaper together
    const std::vector<bool> said = has_changed(rows);
    for (std::size_t k = 0; k < rows.size(); ++k)
      answers_[rows[k]] = said[k] ? Answer::changed : Answer::same;
    asked_.insert(asked_.end(), rows.begin(), rows.end());
  }

  int width_ = 1, height_ = 1;
  std::vector<std::uint32_t> first_;  // of each pixel, into of_pixel_
  std::vector<Index> of_pixel_;
  std::vector<Answer> answers_;
  std::vector<Index> asked_;
};

}  // namespace

std::vector<Index> ask_for_changes(std::span<const Vec2f> pixel, std::size_t rows,
                                   const HasChanged& has_changed) {
  if (rows == 0) return {};
  return ChangeSearch(pixel, rows).run(has_changed);
}

}  // namespace lumirank::methods
