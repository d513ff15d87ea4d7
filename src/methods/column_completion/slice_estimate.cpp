#include "methods/column_completion/slice_estimate.h"

#include <algorithm>
#include <cmath>

namespace lumirank::methods {

using matrix::Index;

namespace {

constexpr std::size_t kChannels = 3;
// Nodes that are divided whatever they seem to err by: the columns drawn of a node may all be dark.
constexpr std::size_t kFirstNodes = 16;
// Where the number of sampled rows is found for each slice: so many at first; for each direction so many
// more; and so many times as many where a fit foretells rows worse than it fits them, by more than
// kOverfitted.
constexpr std::size_t kFewestRows = 24, kRowsPerDirection = 2;
constexpr double kMoreRows = 1.5, kOverfitted = 1.5;
// But no more than so many for each direction: a column that so many do not foretell lies outside of the
// space. Without an end to it columns of noise made half of all rows be sampled, of all columns after them.
constexpr double kMostRowsPerDirection = 2.5;
// A space with more directions than this share of the sampled rows tells nothing of a column.
constexpr double kMostDirections = 0.5;

// x may be shorter than y.
void add_to(std::vector<double>& y, std::span<const double> x, double factor) {
  if (y.size() < x.size()) y.resize(x.size(), 0.0);
  for (std::size_t d = 0; d < x.size(); ++d) y[d] += factor * x[d];
}

void as_numbers(std::span<const Rgb> values, std::vector<float>& out) {
  out.resize(values.size() * kChannels);
  for (std::size_t a = 0; a < values.size(); ++a)
    for (std::size_t c = 0; c < kChannels; ++c) out[a * kChannels + c] = values[a][static_cast<int>(c)];
}

}  // namespace

void SliceEstimate::run(std::span<const Index> rows, matrix::EntryReader& reader, double quality,
                        std::uint64_t seed, std::span<Rgb> sums) {
  rows_ = rows, reader_ = &reader, entries_ = 0;
  sigma_ = settings_.sigma / quality, beta_ = settings_.beta / quality;
  rng_ = Rng(seed, Stage::method, matrix::Index{rows.front()});
  reader.set_rows(rows);
  add_strong_emitters();
  entries_ += draws_.begin(rows, reader, rng_);
  for (Kind& kind : kinds_) {
    kind.space.begin(rows.size(), kChannels);
    kind.known.clear(), kind.total.clear(), kind.sampled.clear();
    kind.wanted = settings_.rho > 0
                      ? static_cast<std::size_t>(std::ceil(settings_.rho * static_cast<double>(rows.size())))
                      : std::min(kFewestRows, rows.size());
    draw_rows(kind, kind.wanted);
  }
  refine();
  write(sums);
  ++counts_.slices;
  for (const Kind& kind : kinds_) {
    counts_.rank += kind.space.rank();
    counts_.max_rank = std::max<std::uint64_t>(counts_.max_rank, kind.space.rank());
  }
  counts_.entries += entries_;
  counts_.max_entries_per_row = std::max(counts_.max_entries_per_row, entries_ / rows.size());
}

void SliceEstimate::add_strong_emitters() {
  emitters_.assign(rows_.size(), Rgb(0));
  values_.resize(rows_.size());
  for (const Index j : tree_.strong_emitters()) {
    reader_->column(j, values_, matrix::Part::value);
    for (std::size_t a = 0; a < rows_.size(); ++a) emitters_[a] += values_[a];
    entries_ += rows_.size();
  }
  emitters_square_ = 0;
  for (const Rgb e : emitters_)
    for (int c = 0; c < 3; ++c) emitters_square_ += static_cast<double>(e[c]) * static_cast<double>(e[c]);
}

// Algorithm 1.
void SliceEstimate::refine() {
  queue_ = {};
  std::vector<Estimated> first;
  for (std::uint32_t k = 0; k < kinds_.size(); ++k) {
    first.push_back(estimate(tree_.roots()[k].node, k, nullptr));
    add_to(kinds_[k].total, first.back().sum, 1);
  }
  std::size_t nodes = first.size();
  std::vector<Estimated> cut;
  const auto take = [&](Estimated&& e) {
    if (tree_.is_leaf(e.node)) return;                        // known
    if (nodes < kFirstNodes) e.error += tree_.power(e.node);  // the strongest is divided first
    const bool divided = nodes < kFirstNodes || e.error > beta_ * light();
    if (divided)
      queue_.push(std::move(e));
    else
      cut.push_back(std::move(e));
  };
  for (Estimated& e : first) take(std::move(e));
  while (!queue_.empty()) {
    const Estimated parent = queue_.top();
    queue_.pop();
    add_to(kinds_[parent.kind].total, parent.sum, -1);
    Estimated children[2] = {estimate(tree_.left(parent.node), parent.kind, &parent),
                             estimate(tree_.right(parent.node), parent.kind, &parent)};
    ++nodes;
    for (const Estimated& e : children) add_to(kinds_[e.kind].total, e.sum, 1);
    for (Estimated& e : children) take(std::move(e));
  }
  counts_.nodes += nodes;
  for (const Estimated& e : cut) draw_again(e);
}

// A node is left whole the sooner the darker its columns happened to be: they may decide, but their mean is
// too dark. What counts is drawn anew once nothing depends on it any more.
void SliceEstimate::draw_again(const Estimated& e) {
  const Estimated again = estimate(e.node, e.kind, nullptr);
  add_to(kinds_[e.kind].total, again.sum, 1);
  add_to(kinds_[e.kind].total, e.sum, -1);
}

// Euclidean norm of what all rows of the slice get, as far as it is known. Light of different kinds has no
// negative product, so the root of the sum of squares is no more than the norm of the sum.
double SliceEstimate::light() const {
  double square = emitters_square_;
  for (const Kind& kind : kinds_)
    for (const double x : kind.total) square += x * x;
  return std::sqrt(square);
}

// Equations 14 and 17.
SliceEstimate::Estimated SliceEstimate::estimate(Node node, std::uint32_t k, const Estimated* parent) {
  Kind& kind = kinds_[k];
  Estimated out{node, k, 0, {}, {}};
  if (tree_.is_leaf(node)) {
    for (const Index j : tree_.columns(node)) {
      const auto& e = complete(j, 1, kind);
      if (out.sum.size() < e.size()) out.sum.resize(e.size(), 0.0);
      for (std::size_t d = 0; d < e.size(); ++d) out.sum[d] += static_cast<double>(e[d]);
    }
    return out;
  }
  if (parent) {
    const double to_left = draws_.left_probability(parent->node);
    const double to_here = node == tree_.left(parent->node) ? to_left : 1 - to_left;
    for (const auto& d : parent->drawn)
      if (tree_.holds(node, d.place)) out.drawn.push_back({d.place, d.probability / to_here});
  }
  while (out.drawn.size() < settings_.samples) out.drawn.push_back(draws_.draw(node, rng_));
  const auto count = static_cast<double>(out.drawn.size());
  double squares = 0;
  for (const auto& d : out.drawn) {
    const double scale = 1 / d.probability;
    const auto& e = complete(tree_.column(d.place), scale / count, kind);
    if (out.sum.size() < e.size()) out.sum.resize(e.size(), 0.0);
    for (std::size_t c = 0; c < e.size(); ++c) {
      const double x = scale * static_cast<double>(e[c]);
      out.sum[c] += x / count;
      squares += x * x;
    }
  }
  double square_of_mean = 0;
  for (const double x : out.sum) square_of_mean += x * x;
  // Standard error of the mean; of one column alone nothing is known, and all of it may be wrong.
  out.error = count > 1 ? std::sqrt(std::max(0.0, squares / count - square_of_mean) / (count - 1))
                        : std::sqrt(square_of_mean);
  return out;
}

// Algorithm 2. `scale`: what the column's light is multiplied with in the node that wants it.
const std::vector<float>& SliceEstimate::complete(Index j, double scale, Kind& kind) {
  if (const auto found = kind.known.find(j); found != kind.known.end()) return found->second;
  ++counts_.columns;
  const std::size_t all = rows_.size();
  for (std::size_t asked = 0;;) {
    const std::size_t sampled = kind.sampled.size();
    if (sampled >= all || kind.space.rank() == 0 ||
        static_cast<double>(kind.space.rank()) > kMostDirections * static_cast<double>(sampled))
      break;
    const auto places = std::span(kind.sampled).subspan(asked);
    values_.resize(sampled), columns_.assign(places.size(), j);
    reader_->entries_at(places, columns_, std::span(values_).subspan(asked), matrix::Part::value);
    entries_ += places.size(), counts_.sampled_rows += places.size();
    as_numbers(values_, numbers_);
    const auto fit = kind.space.fit(numbers_, coordinates_);
    const double more = std::sqrt(static_cast<double>(all) / static_cast<double>(sampled));
    if (fit.left_out * more * scale <= sigma_ * light()) return kind.known[j] = coordinates_;
    const double most =
        static_cast<double>(kFewestRows) + kMostRowsPerDirection * static_cast<double>(kind.space.rank());
    if (settings_.rho > 0 || !(fit.left_out > kOverfitted * fit.residual) || 2 * sampled > all ||
        static_cast<double>(sampled) > most)
      break;
    // More rows, those that are sampled already among them.
    kind.wanted = static_cast<std::size_t>(kMoreRows * static_cast<double>(sampled));
    asked = sampled;
    draw_rows(kind, kind.wanted);
  }
  return sample_wholly(j, kind);
}

const std::vector<float>& SliceEstimate::sample_wholly(Index j, Kind& kind) {
  values_.resize(rows_.size());
  reader_->column(j, values_, matrix::Part::value);
  entries_ += rows_.size();
  ++counts_.dense;
  as_numbers(values_, numbers_);
  kind.space.add(numbers_, coordinates_);
  // Rows stay as they were drawn until a space of so many directions needs more of them.
  const std::size_t needed = kFewestRows + kRowsPerDirection * kind.space.rank();
  if (settings_.rho <= 0 && needed > kind.wanted) {
    kind.wanted = std::min(rows_.size(), static_cast<std::size_t>(kMoreRows * static_cast<double>(needed)));
    draw_rows(kind, kind.wanted);
  }
  return kind.known[j] = coordinates_;
}

// Those that are there stay; one of each stretch of what is left.
void SliceEstimate::draw_rows(Kind& kind, std::size_t count) {
  const std::size_t all = rows_.size();
  count = std::clamp<std::size_t>(count, 1, all);
  std::vector<std::uint8_t> taken(all, 0);
  for (const std::uint32_t a : kind.sampled) taken[a] = 1;
  std::vector<std::uint32_t> left;
  for (std::uint32_t a = 0; a < all; ++a)
    if (!taken[a]) left.push_back(a);
  const std::size_t wanted = count > kind.sampled.size() ? count - kind.sampled.size() : 0;
  for (std::size_t k = 0; k < wanted; ++k) {
    const std::size_t begin = k * left.size() / wanted, end = (k + 1) * left.size() / wanted;
    kind.sampled.push_back(left[begin + rng_.next_below(end - begin)]);
  }
  kind.space.sample(kind.sampled);
}

// Equation 15.
void SliceEstimate::write(std::span<Rgb> sums) {
  numbers_.resize(rows_.size() * kChannels);
  for (const Index i : rows_) sums[i] = Rgb(0);
  for (Kind& kind : kinds_) {
    coordinates_.assign(kind.total.begin(), kind.total.end());
    kind.space.combine(coordinates_, numbers_);
    for (std::size_t a = 0; a < rows_.size(); ++a)
      for (std::size_t c = 0; c < kChannels; ++c)
        sums[rows_[a]][static_cast<int>(c)] += numbers_[a * kChannels + c];
  }
  // Where a fit overshoots, a dark row may come out below zero.
  for (std::size_t a = 0; a < rows_.size(); ++a)
    for (int c = 0; c < 3; ++c) sums[rows_[a]][c] = std::max(sums[rows_[a]][c], 0.0f) + emitters_[a][c];
}

}  // namespace lumirank::methods
