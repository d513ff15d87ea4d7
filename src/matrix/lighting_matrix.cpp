#include "matrix/lighting_matrix.h"

#include "matrix/entry_reader.h"

namespace lumirank::matrix {
namespace {

class ForwardingReader final : public EntryReader {
 public:
  explicit ForwardingReader(const LightingMatrix& matrix) : matrix_(matrix) {}
  void set_rows(std::span<const Index> rows) override { rows_.assign(rows.begin(), rows.end()); }
  void column(Index j, std::span<Rgb> out, Part part) override {
    matrix_.block(rows_, std::span(&j, 1), out, part);
  }
  void entries_at(std::span<const std::uint32_t> places, std::span<const Index> columns, std::span<Rgb> out,
                  Part part) override {
    listed_.clear();
    for (const std::uint32_t place : places) listed_.push_back(rows_[place]);
    matrix_.entries(listed_, columns, out, part);
  }
  void entries(std::span<const Index> rows, std::span<const Index> columns, std::span<Rgb> out,
               Part part) override {
    matrix_.entries(rows, columns, out, part);
  }

 private:
  const LightingMatrix& matrix_;
  std::vector<Index> rows_, listed_;
};

}  // namespace

std::unique_ptr<EntryReader> LightingMatrix::reader() const {
  return std::make_unique<ForwardingReader>(*this);
}

}  // namespace lumirank::matrix
