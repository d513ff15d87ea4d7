#include "matrix/block_diagonal.h"

#include <algorithm>
#include <limits>

#include "base/error.h"
#include "base/random.h"
#include "matrix/entry_reader.h"

namespace lumirank::matrix {

// Entries of several instants, parted by them: what each block is asked for, and where its answers go.
struct AskedOfInstant {
  std::vector<Index> rows, columns;
  std::vector<std::uint32_t> places, to;
  std::vector<Rgb> values;
  void clear() { rows.clear(), columns.clear(), places.clear(), to.clear(); }
};

namespace {

// Appends the features of one block, of all of which some may be unknown.
template <typename T>
void append_feature(std::vector<T>& all, std::span<const T> of_block) {
  all.insert(all.end(), of_block.begin(), of_block.end());
}
template <typename T>
void require_whole(std::vector<T>& all, std::size_t count) {
  if (all.size() != count) all.clear();
}

}  // namespace

BlockDiagonal::BlockDiagonal(std::vector<std::shared_ptr<const LightingMatrix>> blocks)
    : blocks_(std::move(blocks)), first_row_{0}, first_column_{0} {
  if (blocks_.empty() || blocks_.size() > std::numeric_limits<std::uint16_t>::max())
    throw InternalError("matrix::BlockDiagonal: one to 65535 instants");
  for (std::size_t k = 0; k < blocks_.size(); ++k) {
    const LightingMatrix& b = *blocks_[k];
    first_row_.push_back(first_row_.back() + b.rows());
    first_column_.push_back(first_column_.back() + b.columns());
    row_instant_.resize(rows(), static_cast<std::uint16_t>(k));
    column_instant_.resize(columns(), static_cast<std::uint16_t>(k));
    const RowFeatures r = b.row_features();
    append_feature(pixel_, r.pixel), append_feature(row_position_, r.position);
    append_feature(row_normal_, r.normal), append_feature(weight_, r.weight);
    append_feature(albedo_, r.albedo);
    for (std::size_t i = 0; i < b.rows(); ++i)
      row_id_.push_back(hash_ids(k, Stage::shutter, id_of(r.id, i), 0));
    const ColumnFeatures c = b.column_features();
    append_feature(column_position_, c.position), append_feature(column_normal_, c.normal);
    append_feature(power_, c.power), append_feature(group_, c.group);
    append_feature(indirect_, c.indirect), append_feature(half_, c.half);
    append_feature(emitted_, c.emitted);
    for (std::size_t j = 0; j < b.columns(); ++j)
      column_id_.push_back(hash_ids(k, Stage::shutter, id_of(c.id, j), 1));
  }
  if (rows() >= std::numeric_limits<Index>::max() || columns() >= std::numeric_limits<Index>::max())
    throw InternalError("matrix::BlockDiagonal: more than 2^32 - 2 rows or columns");
  require_whole(pixel_, rows()), require_whole(row_position_, rows()), require_whole(row_normal_, rows());
  require_whole(weight_, rows()), require_whole(albedo_, rows());
  require_whole(column_position_, columns()), require_whole(column_normal_, columns());
  require_whole(power_, columns()), require_whole(group_, columns()), require_whole(indirect_, columns());
  require_whole(half_, columns()), require_whole(emitted_, columns());
}

void BlockDiagonal::scale_power(std::size_t column, float factor) {
  if (!power_.empty()) power_[column] *= factor;
  if (!emitted_.empty()) emitted_[column] *= factor;
}

Cost BlockDiagonal::row(Index i, std::span<Rgb> out, Part part) const {
  const std::size_t k = row_instant_[i];
  std::fill(out.begin(), out.end(), Rgb(0));
  return at(k).row(static_cast<Index>(i - first_row_[k]),
                   out.subspan(first_column_[k], first_column_[k + 1] - first_column_[k]), part);
}

Cost BlockDiagonal::column(Index j, std::span<Rgb> out, Part part) const {
  const std::size_t k = column_instant_[j];
  std::fill(out.begin(), out.end(), Rgb(0));
  return at(k).column(static_cast<Index>(j - first_column_[k]),
                      out.subspan(first_row_[k], first_row_[k + 1] - first_row_[k]), part);
}

Cost BlockDiagonal::block(std::span<const Index> rows, std::span<const Index> columns, std::span<Rgb> out,
                          Part part) const {
  std::fill(out.begin(), out.end(), Rgb(0));
  Cost cost;
  AskedOfInstant asked;
  for (std::size_t k = 0; k < blocks_.size(); ++k) {
    asked.clear();
    for (std::size_t b = 0; b < columns.size(); ++b)
      if (column_instant_[columns[b]] == k)
        asked.columns.push_back(static_cast<Index>(columns[b] - first_column_[k])),
            asked.to.push_back(static_cast<std::uint32_t>(b));
    for (std::size_t a = 0; a < rows.size(); ++a)
      if (row_instant_[rows[a]] == k)
        asked.rows.push_back(static_cast<Index>(rows[a] - first_row_[k])),
            asked.places.push_back(static_cast<std::uint32_t>(a));
    if (asked.rows.empty() || asked.columns.empty()) continue;
    asked.values.resize(asked.rows.size() * asked.columns.size());
    cost += at(k).block(asked.rows, asked.columns, asked.values, part);
    for (std::size_t a = 0; a < asked.rows.size(); ++a)
      for (std::size_t b = 0; b < asked.columns.size(); ++b)
        out[asked.places[a] * columns.size() + asked.to[b]] = asked.values[a * asked.columns.size() + b];
  }
  return cost;
}

Cost BlockDiagonal::entries(std::span<const Index> rows, std::span<const Index> columns, std::span<Rgb> out,
                            Part part) const {
  std::vector<AskedOfInstant> asked(blocks_.size());
  for (std::size_t n = 0; n < rows.size(); ++n) {
    const std::size_t k = row_instant_[rows[n]];
    out[n] = Rgb(0);
    if (column_instant_[columns[n]] != k) continue;
    asked[k].rows.push_back(static_cast<Index>(rows[n] - first_row_[k]));
    asked[k].columns.push_back(static_cast<Index>(columns[n] - first_column_[k]));
    asked[k].to.push_back(static_cast<std::uint32_t>(n));
  }
  Cost cost;
  for (std::size_t k = 0; k < blocks_.size(); ++k) {
    if (asked[k].rows.empty()) continue;
    asked[k].values.resize(asked[k].rows.size());
    cost += at(k).entries(asked[k].rows, asked[k].columns, asked[k].values, part);
    for (std::size_t n = 0; n < asked[k].to.size(); ++n) out[asked[k].to[n]] = asked[k].values[n];
  }
  return cost;
}

Cost BlockDiagonal::accumulate(std::span<const ScaledColumn> columns, std::span<Rgb> sums,
                               const Sinks& sinks) const {
  std::vector<std::vector<ScaledColumn>> asked(blocks_.size());
  for (ScaledColumn c : columns) {
    const std::size_t k = column_instant_[c.column];
    c.column -= static_cast<Index>(first_column_[k]);
    asked[k].push_back(c);
  }
  Cost cost;
  for (std::size_t k = 0; k < blocks_.size(); ++k)
    if (!asked[k].empty())
      cost +=
          at(k).accumulate(asked[k], sums.subspan(first_row_[k], first_row_[k + 1] - first_row_[k]), sinks);
  return cost;
}

class BlockDiagonal::Reader final : public EntryReader {
 public:
  explicit Reader(const BlockDiagonal& all) : all_(all), asked_(all.instants()), rows_(all.instants()) {
    for (std::size_t k = 0; k < all.instants(); ++k) readers_.push_back(all.at(k).reader());
  }

  void set_rows(std::span<const Index> rows) override {
    given_.assign(rows.begin(), rows.end());
    place_.resize(rows.size());
    for (auto& own : rows_) own.clear();
    for (std::size_t a = 0; a < rows.size(); ++a) {
      const std::size_t k = all_.row_instant_[rows[a]];
      place_[a] = static_cast<std::uint32_t>(rows_[k].size());
      rows_[k].push_back(static_cast<Index>(rows[a] - all_.first_row_[k]));
    }
    for (std::size_t k = 0; k < readers_.size(); ++k)
      if (!rows_[k].empty()) readers_[k]->set_rows(rows_[k]);
  }

  Cost column(Index j, std::span<Rgb> out, Part part) override {
    const std::size_t k = all_.column_instant_[j];
    std::fill(out.begin(), out.end(), Rgb(0));
    if (rows_[k].empty()) return {};
    std::vector<Rgb>& values = asked_[k].values;
    values.resize(rows_[k].size());
    const Cost cost = readers_[k]->column(static_cast<Index>(j - all_.first_column_[k]), values, part);
    for (std::size_t a = 0; a < given_.size(); ++a)
      if (all_.row_instant_[given_[a]] == k) out[a] = values[place_[a]];
    return cost;
  }

  Cost entries_at(std::span<const std::uint32_t> places, std::span<const Index> columns, std::span<Rgb> out,
                  Part part) override {
    for (AskedOfInstant& asked : asked_) asked.clear();
    for (std::size_t n = 0; n < places.size(); ++n) {
      const std::size_t k = all_.row_instant_[given_[places[n]]];
      out[n] = Rgb(0);
      if (all_.column_instant_[columns[n]] != k) continue;
      asked_[k].places.push_back(place_[places[n]]);
      asked_[k].columns.push_back(static_cast<Index>(columns[n] - all_.first_column_[k]));
      asked_[k].to.push_back(static_cast<std::uint32_t>(n));
    }
    Cost cost;
    for (std::size_t k = 0; k < asked_.size(); ++k) {
      AskedOfInstant& asked = asked_[k];
      if (asked.places.empty()) continue;
      asked.values.resize(asked.places.size());
      cost += readers_[k]->entries_at(asked.places, asked.columns, asked.values, part);
      for (std::size_t n = 0; n < asked.to.size(); ++n) out[asked.to[n]] = asked.values[n];
    }
    return cost;
  }

  Cost entries(std::span<const Index> rows, std::span<const Index> columns, std::span<Rgb> out,
               Part part) override {
    return all_.entries(rows, columns, out, part);
  }

 private:
  const BlockDiagonal& all_;
  std::vector<std::unique_ptr<EntryReader>> readers_;
  std::vector<AskedOfInstant> asked_;
  std::vector<Index> given_;              // rows as set
  std::vector<std::uint32_t> place_;      // of each, among those of its instant
  std::vector<std::vector<Index>> rows_;  // by instant
};

std::unique_ptr<EntryReader> BlockDiagonal::reader() const { return std::make_unique<Reader>(*this); }

Capabilities BlockDiagonal::capabilities() const {
  Capabilities out = Capabilities::all();
  for (const auto& b : blocks_) out = out.without(Capabilities::all().without(b->capabilities()));
  return out;
}

ColumnSet BlockDiagonal::column_set(Index j) const {
  const std::size_t k = column_instant_[j];
  return at(k).column_set(static_cast<Index>(j - first_column_[k]));
}

class BlockDiagonal::Bounds final : public RowBounds {
 public:
  explicit Bounds(const BlockDiagonal& all) : all_(all), bounds_(all.instants()), rows_(all.instants()) {}

  void set_rows(std::span<const Index> rows) override {
    for (auto& own : rows_) own.clear();
    for (const Index i : rows) {
      const std::size_t k = all_.row_instant_[i];
      rows_[k].push_back(static_cast<Index>(i - all_.first_row_[k]));
    }
    for (std::size_t k = 0; k < rows_.size(); ++k) {
      if (rows_[k].empty()) continue;
      if (!bounds_[k]) bounds_[k] = all_.at(k).row_bounds();
      bounds_[k]->set_rows(rows_[k]);
    }
  }
  Rgb bound(const ColumnSet& set) const override {
    Rgb most{0};
    for (std::size_t k = 0; k < rows_.size(); ++k) {
      if (rows_[k].empty()) continue;
      const Rgb own = bounds_[k]->bound(set);
      for (int c = 0; c < 3; ++c) most[c] = std::max(most[c], own[c]);
    }
    return most;
  }

 private:
  const BlockDiagonal& all_;
  std::vector<std::unique_ptr<RowBounds>> bounds_;
  std::vector<std::vector<Index>> rows_;  // by instant
};

std::unique_ptr<RowBounds> BlockDiagonal::row_bounds() const { return std::make_unique<Bounds>(*this); }

RowFeatures BlockDiagonal::row_features() const {
  return {pixel_, row_position_, row_normal_, weight_, row_id_, albedo_, row_instant_};
}
ColumnFeatures BlockDiagonal::column_features() const {
  return {column_position_, column_normal_, power_,         group_, indirect_, half_,
          emitted_,         column_id_,     column_instant_};
}

}  // namespace lumirank::matrix
