#include "matrix/metered_matrix.h"

#include <algorithm>

#include "matrix/entry_reader.h"

namespace lumirank::matrix {

void MeteredMatrix::Meter::add(const Cost& cost) {
  // One writer: a load and a store do for an addition.
  const auto more = [](auto& number, auto by) {
    number.store(number.load(std::memory_order_relaxed) + by, std::memory_order_relaxed);
  };
  more(counts[0], cost.entries), more(counts[1], cost.culled), more(counts[2], cost.rays);
  more(energies[0], cost.energy), more(energies[1], cost.clamped), more(energies[2], cost.lost);
}

Cost MeteredMatrix::Meter::read() const {
  const auto now = [](const auto& number) { return number.load(std::memory_order_relaxed); };
  return {now(counts[0]),   now(counts[1]),   now(counts[2]),
          now(energies[0]), now(energies[1]), now(energies[2])};
}

class MeteredMatrix::Reader final : public EntryReader {
 public:
  Reader(const MeteredMatrix& owner, Meter& meter)
      : owner_(owner), meter_(meter), reader_(owner.matrix_.reader()) {}
  ~Reader() override {
    const std::lock_guard lock(owner_.mutex_);
    owner_.spent_ += meter_.read();
    std::erase_if(owner_.meters_, [&](const auto& meter) { return meter.get() == &meter_; });
  }

  void set_rows(std::span<const Index> rows) override { reader_->set_rows(rows); }
  Cost column(Index j, std::span<Rgb> out, Part part) override {
    return spend(reader_->column(j, out, part));
  }
  Cost unoccluded_scalars(Index j, Rgb weights, std::span<float> out) override {
    return spend(reader_->unoccluded_scalars(j, weights, out));
  }
  Cost add_unoccluded(std::span<const ScaledColumn> columns, std::span<const float> shares,
                      std::span<const std::uint32_t> of, std::span<Rgb> sums) override {
    return spend(reader_->add_unoccluded(columns, shares, of, sums));
  }
  Cost entries_at(std::span<const std::uint32_t> places, std::span<const Index> columns, std::span<Rgb> out,
                  Part part) override {
    return spend(reader_->entries_at(places, columns, out, part));
  }
  Cost entries(std::span<const Index> rows, std::span<const Index> columns, std::span<Rgb> out,
               Part part) override {
    return spend(reader_->entries(rows, columns, out, part));
  }

 private:
  Cost spend(const Cost& cost) {
    meter_.add(cost);
    return cost;
  }

  const MeteredMatrix& owner_;
  Meter& meter_;
  std::unique_ptr<EntryReader> reader_;
};

MeteredMatrix::MeteredMatrix(const LightingMatrix& matrix) : matrix_(matrix) {}
MeteredMatrix::~MeteredMatrix() = default;

Cost MeteredMatrix::spend(const Cost& cost) const {
  const std::lock_guard lock(mutex_);
  spent_ += cost;
  return cost;
}

Cost MeteredMatrix::total() const {
  const std::lock_guard lock(mutex_);
  Cost sum = spent_;
  for (const auto& meter : meters_) sum += meter->read();
  return sum;
}

Cost MeteredMatrix::row(Index i, std::span<Rgb> out, Part part) const {
  return spend(matrix_.row(i, out, part));
}
Cost MeteredMatrix::column(Index j, std::span<Rgb> out, Part part) const {
  return spend(matrix_.column(j, out, part));
}
Cost MeteredMatrix::block(std::span<const Index> rows, std::span<const Index> columns, std::span<Rgb> out,
                          Part part) const {
  return spend(matrix_.block(rows, columns, out, part));
}
Cost MeteredMatrix::entries(std::span<const Index> rows, std::span<const Index> columns, std::span<Rgb> out,
                            Part part) const {
  return spend(matrix_.entries(rows, columns, out, part));
}
Cost MeteredMatrix::accumulate(std::span<const ScaledColumn> columns, std::span<Rgb> sums,
                               const Sinks& sinks) const {
  return spend(matrix_.accumulate(columns, sums, sinks));
}

std::unique_ptr<EntryReader> MeteredMatrix::reader() const {
  auto own = std::make_unique<Meter>();
  Meter& meter = *own;
  {
    const std::lock_guard lock(mutex_);
    meters_.push_back(std::move(own));
  }
  return std::make_unique<Reader>(*this, meter);
}

}  // namespace lumirank::matrix
