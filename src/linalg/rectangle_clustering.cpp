#include "linalg/rectangle_clustering.h"

#include <algorithm>
#include <numeric>

#include "base/parallel.h"
#include "base/random.h"

namespace lumirank::linalg {

// Of some pairs: Σw, Σ w‖x‖² and Σ w x. Since x is rounded, ‖x‖ is not quite 1; with its own length equal
// columns cost nothing.
struct TensorSum {
  double weight = 0, squares = 0;
  std::vector<double> vector;
  explicit TensorSum(std::size_t rows = 0) : vector(rows) {}
  void add(const TensorSum& other) {
    weight += other.weight, squares += other.squares;
    for (std::size_t i = 0; i < vector.size(); ++i) vector[i] += other.vector[i];
  }
  void add(double w, const float* x) {
    double square = 0;
    for (std::size_t i = 0; i < vector.size(); ++i) {
      const auto v = static_cast<double>(x[i]);
      square += v * v;
      vector[i] += w * v;
    }
    weight += w, squares += w * square;
  }
};

namespace {

// Below this share of the square of the summed weights a cost is rounding.
constexpr double kNoCost = 1e-12;

double tensor_cost(double weight, double squares, double square_of_sum) {
  const double cost = 2 * (weight * squares - square_of_sum);
  return cost > kNoCost * weight * weight ? cost : 0.0;
}
double tensor_cost(const TensorSum& s) {
  double square = 0;
  for (const double v : s.vector) square += v * v;
  return tensor_cost(s.weight, s.squares, square);
}
// Of all but a part of them.
double rest_cost(const TensorSum& all, const TensorSum& part) {
  double square = 0;
  for (std::size_t i = 0; i < all.vector.size(); ++i) {
    const double v = all.vector[i] - part.vector[i];
    square += v * v;
  }
  return tensor_cost(all.weight - part.weight, all.squares - part.squares, square);
}

}  // namespace

struct RectangleClustering::Sums {
  TensorSum all;
  std::vector<TensorSum> frames, lights;
};

RectangleClustering::RectangleClustering(const ReducedTensor& tensor, const Partition& start,
                                         std::uint64_t seed, double time_weight)
    : tensor_(tensor), seed_(seed), time_weight_(time_weight) {
  for (std::size_t k = 0; k < start.clusters(); ++k) {
    const auto members = start.members(k);
    rectangles_.push_back(
        {{members.begin(), members.end()}, 0, static_cast<std::uint32_t>(tensor.frames()), 0});
  }
  parallel_for(rectangles_.size(), 1, [&](std::size_t b, std::size_t e) {
    for (std::size_t k = b; k < e; ++k) rectangles_[k].cost = tensor_cost(sums_of(rectangles_[k]).all);
  });
  splits_.resize(rectangles_.size());
  for (std::uint32_t k = 0; k < rectangles_.size(); ++k)
    if (rectangles_[k].cost > 0) queue_.emplace(-rectangles_[k].cost, k);
}

RectangleClustering::Sums RectangleClustering::sums_of(const Rectangle& r) const {
  const std::size_t rows = tensor_.rows();
  Sums sums;
  sums.all = TensorSum(rows);
  sums.frames.assign(r.end - r.begin, TensorSum(rows));
  sums.lights.assign(r.lights.size(), TensorSum(rows));
  std::vector<float> x(rows);
  for (std::size_t j = 0; j < r.lights.size(); ++j) {
    for (std::uint32_t frame = r.begin; frame < r.end; ++frame) {
      const auto w = static_cast<double>(tensor_.weight(r.lights[j], frame));
      if (!(w > 0)) continue;
      tensor_.information(r.lights[j], frame, x.data());
      sums.lights[j].add(w, x.data());
      sums.frames[frame - r.begin].add(w, x.data());
    }
    sums.all.add(sums.lights[j]);
  }
  return sums;
}

void RectangleClustering::split_in_time(const Rectangle& r, const Sums& sums, Split& best) const {
  TensorSum before(tensor_.rows());
  double least = -1;
  for (std::uint32_t frame = r.begin + 1; frame < r.end; ++frame) {
    before.add(sums.frames[frame - 1 - r.begin]);
    const double left = tensor_cost(before), right = rest_cost(sums.all, before);
    if (least < 0 || left + right < least) {
      least = left + right;
      best.known = best.in_time = true;
      best.frame = frame, best.left_cost = left, best.right_cost = right;
    }
  }
}

// Of every light on the line through two of them, in the space of their information vectors of all frames.
std::vector<float> RectangleClustering::projections(const Rectangle& r, std::size_t a, std::size_t b) const {
  const std::size_t rows = tensor_.rows(), frames = r.end - r.begin;
  std::vector<float> line(rows * frames), x(rows), along(r.lights.size(), 0.0f);
  for (std::size_t k = 0; k < frames; ++k) {
    tensor_.information(r.lights[a], r.begin + k, x.data());
    for (std::size_t i = 0; i < rows; ++i) line[k * rows + i] = -x[i];
    tensor_.information(r.lights[b], r.begin + k, x.data());
    for (std::size_t i = 0; i < rows; ++i) line[k * rows + i] += x[i];
  }
  for (std::size_t j = 0; j < r.lights.size(); ++j)
    for (std::size_t k = 0; k < frames; ++k) {
      tensor_.information(r.lights[j], r.begin + k, x.data());
      along[j] +=
          std::inner_product(x.begin(), x.end(), line.begin() + static_cast<std::ptrdiff_t>(k * rows), 0.0f);
    }
  return along;
}

void RectangleClustering::split_in_lights(const Rectangle& r, const Sums& sums, std::uint64_t key,
                                          Split& best) const {
  const std::size_t lights = r.lights.size();
  if (lights < 2) return;
  // Two lights, each in proportion to its weight over the frames.
  const auto draw = [&](double u) {
    double running = 0;
    for (std::size_t j = 0; j < lights; ++j)
      if ((running += sums.lights[j].weight) > u * sums.all.weight) return j;
    return lights - 1;
  };
  Rng rng(seed_, Stage::clustering, key);
  const std::size_t a = draw(rng.next_double());
  std::size_t b = a;
  for (int attempt = 0; attempt < 8 && b == a; ++attempt) b = draw(rng.next_double());
  if (a == b) b = a == 0 ? lights - 1 : 0;
  const std::vector<float> along = projections(r, a, b);
  std::vector<std::uint32_t> order(lights);
  std::iota(order.begin(), order.end(), 0u);
  std::sort(order.begin(), order.end(), [&](std::uint32_t m, std::uint32_t n) {
    return along[m] != along[n] ? along[m] < along[n] : r.lights[m] < r.lights[n];
  });
  TensorSum before(tensor_.rows());
  Split found;
  double least = -1;
  for (std::size_t k = 0; k + 1 < lights; ++k) {
    before.add(sums.lights[order[k]]);
    const double left = tensor_cost(before), right = rest_cost(sums.all, before);
    if (least < 0 || left + right < least) {
      least = left + right;
      found.left = k + 1, found.left_cost = left, found.right_cost = right;
    }
  }
  const double of_time = best.left_cost + best.right_cost;
  if (best.in_time && of_time < time_weight_ * least) return;
  found.known = true;
  for (const std::uint32_t k : order) found.sorted.push_back(r.lights[k]);
  best = std::move(found);
}

RectangleClustering::Split RectangleClustering::best_split(std::size_t k) const {
  const Rectangle& r = rectangles_[k];
  const Sums sums = sums_of(r);
  Split best;
  if (time_weight_ > 0) split_in_time(r, sums, best);
  split_in_lights(r, sums, k, best);
  return best;
}

// Splits of the costliest are found side by side; which are found ahead changes nothing but time.
void RectangleClustering::prepare_costliest(std::size_t wanted) {
  std::vector<std::uint32_t> next;
  for (auto it = queue_.begin(); it != queue_.end() && next.size() < std::min<std::size_t>(wanted, 64); ++it)
    if (!splits_[it->second].known) next.push_back(it->second);
  parallel_for(next.size(), 1, [&](std::size_t b, std::size_t e) {
    for (std::size_t k = b; k < e; ++k) splits_[next[k]] = best_split(next[k]);
  });
}

bool RectangleClustering::split_to(std::size_t clusters) {
  while (rectangles_.size() < clusters && !queue_.empty()) {
    const std::uint32_t k = queue_.begin()->second;
    if (!splits_[k].known) prepare_costliest(clusters - rectangles_.size());
    queue_.erase(queue_.begin());
    const Split split = std::move(splits_[k]);
    splits_[k] = {};
    if (!split.known) continue;  // a single pair
    Rectangle &left = rectangles_[k], right = left;
    if (split.in_time) {
      left.end = right.begin = split.frame;
    } else {
      const auto middle = split.sorted.begin() + static_cast<std::ptrdiff_t>(split.left);
      left.lights.assign(split.sorted.begin(), middle);
      right.lights.assign(middle, split.sorted.end());
    }
    left.cost = split.left_cost, right.cost = split.right_cost;
    const auto fresh = static_cast<std::uint32_t>(rectangles_.size());
    if (left.cost > 0) queue_.emplace(-left.cost, k);
    if (right.cost > 0) queue_.emplace(-right.cost, fresh);
    rectangles_.push_back(std::move(right));
    splits_.emplace_back();
  }
  return rectangles_.size() >= clusters;
}

double RectangleClustering::cost() const {
  double sum = 0;
  for (const Rectangle& r : rectangles_) sum += r.cost;
  return sum;
}

}  // namespace lumirank::linalg
