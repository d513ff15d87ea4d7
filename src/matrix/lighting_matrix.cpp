#include "matrix/lighting_matrix.h"

#include "base/error.h"
#include "matrix/entry_reader.h"

namespace lumirank::matrix {
namespace {

class ForwardingReader final : public EntryReader {
 public:
  explicit ForwardingReader(const LightingMatrix& matrix) : matrix_(matrix) {}
  void set_rows(std::span<const Index> rows) override { rows_.assign(rows.begin(), rows.end()); }
  Cost column(Index j, std::span<Rgb> out, Part part) override {
    return matrix_.block(rows_, std::span(&j, 1), out, part);
  }
  Cost entries_at(std::span<const std::uint32_t> places, std::span<const Index> columns, std::span<Rgb> out,
                  Part part) override {
    listed_.clear();
    for (const std::uint32_t place : places) listed_.push_back(rows_[place]);
    return matrix_.entries(listed_, columns, out, part);
  }
  Cost entries(std::span<const Index> rows, std::span<const Index> columns, std::span<Rgb> out,
               Part part) override {
    return matrix_.entries(rows, columns, out, part);
  }

 private:
  const LightingMatrix& matrix_;
  std::vector<Index> rows_, listed_;
};

}  // namespace

std::unique_ptr<EntryReader> LightingMatrix::reader() const {
  return std::make_unique<ForwardingReader>(*this);
}

Capabilities LightingMatrix::capabilities() const {
  Capabilities out;
  const auto note = [&](auto feature, std::size_t count, Ability ability) {
    if (feature.size() == count) out = out.with({ability});
  };
  const RowFeatures r = row_features();
  note(r.pixel, rows(), Ability::row_pixel), note(r.position, rows(), Ability::row_position);
  note(r.normal, rows(), Ability::row_normal), note(r.weight, rows(), Ability::row_weight);
  note(r.id, rows(), Ability::row_id);
  const ColumnFeatures c = column_features();
  note(c.position, columns(), Ability::column_position), note(c.normal, columns(), Ability::column_normal);
  note(c.power, columns(), Ability::column_power), note(c.group, columns(), Ability::column_group);
  note(c.indirect, columns(), Ability::column_indirect), note(c.half, columns(), Ability::column_half);
  note(c.emitted, columns(), Ability::column_emitted), note(c.id, columns(), Ability::column_id);
  return out;
}

ColumnSet LightingMatrix::column_set(Index) const {
  throw InternalError("this lighting matrix has no bounds; check capabilities() first");
}
std::unique_ptr<RowBounds> LightingMatrix::row_bounds() const {
  throw InternalError("this lighting matrix has no bounds; check capabilities() first");
}

}  // namespace lumirank::matrix
