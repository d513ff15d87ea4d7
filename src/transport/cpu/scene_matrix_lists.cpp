// Entries and blocks of a SceneMatrix: pairs in any order, sorted into groups of one class.
#include "base/error.h"
#include "base/parallel.h"
#include "transport/cpu/pair_list.h"
#include "transport/cpu/scene_matrix_impl.h"

namespace lumirank::transport {

using matrix::Cost;
using matrix::Index;
using matrix::Part;

namespace {

constexpr std::size_t kPiece = 4096;  // pairs per task

}  // namespace

Cost SceneMatrix::entries(std::span<const Index> row_ids, std::span<const Index> column_ids,
                          std::span<Rgb> out, Part part) const {
  if (row_ids.size() != column_ids.size() || out.size() != row_ids.size())
    throw InternalError("transport::SceneMatrix::entries: rows, columns and out differ in length");
  const auto &rows = impl_->rows.plan.slot, &columns = impl_->columns.plan.slot;
  const Cost all = parallel_sum(row_ids.size(), kPiece, Cost{}, [&](std::size_t begin, std::size_t end) {
    PairList list(impl_->context);
    for (std::size_t k = begin; k < end; ++k) list.add(rows[row_ids[k]], columns[column_ids[k]]);
    Impl::Lease block(*impl_);
    return list.evaluate(*block, part, [&](std::uint32_t k) -> Rgb& { return out[begin + k]; });
  });
  return with_loss(impl_->context, all);
}

Cost SceneMatrix::block(std::span<const Index> row_ids, std::span<const Index> column_ids, std::span<Rgb> out,
                        Part part) const {
  if (out.size() != row_ids.size() * column_ids.size())
    throw InternalError("transport::SceneMatrix::block: out is not rows × columns");
  const auto &rows = impl_->rows.plan.slot, &columns = impl_->columns.plan.slot;
  // Along the longer side, so that rays of a packet share an end.
  const bool by_column = row_ids.size() >= column_ids.size();
  const std::size_t across = by_column ? row_ids.size() : column_ids.size();
  const Cost all = parallel_sum(out.size(), kPiece, Cost{}, [&](std::size_t begin, std::size_t end) {
    const auto place = [&](std::size_t k) {
      const std::size_t line = k / across, along = k % across;
      return by_column ? std::pair(along, line) : std::pair(line, along);
    };
    PairList list(impl_->context);
    for (std::size_t k = begin; k < end; ++k)
      list.add(rows[row_ids[place(k).first]], columns[column_ids[place(k).second]]);
    Impl::Lease block(*impl_);
    return list.evaluate(*block, part, [&](std::uint32_t k) -> Rgb& {
      const auto [a, b] = place(begin + k);
      return out[a * column_ids.size() + b];
    });
  });
  return with_loss(impl_->context, all);
}

}  // namespace lumirank::transport
