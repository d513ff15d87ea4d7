#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <set>
#include <stdexcept>

#include "base/error.h"
#include "base/parallel.h"
#include "matrix/entry_reader.h"
#include "matrix/synthetic.h"
#include "methods/common/column_pass.h"
#include "methods/common/row_group_pass.h"
#include "methods/common/timed_choices.h"

namespace lumirank::methods {
namespace {

using matrix::DenseMatrix;
using matrix::Index;

struct Workspace {
  std::unique_ptr<matrix::EntryReader> reader;
  std::vector<Index> columns;
  std::vector<Rgb> values;
  std::size_t row_groups = 0;
};

// Row sums by way of a reader: what a method would do, at its plainest.
class RowSums {
 public:
  explicit RowSums(const DenseMatrix& m)
      : row_groups_(RowGroups::single(m.rows())), matrix_(m), pool_([&m] {
          auto w = std::make_unique<Workspace>();
          w->reader = m.reader();
          w->columns.resize(m.columns());
          w->values.resize(m.columns());
          std::iota(w->columns.begin(), w->columns.end(), 0u);
          return w;
        }) {}

  RowGroupResult run(const RunOptions& options, std::vector<Rgb>& sums, double deadline = 0) {
    const RunClock timer(options);
    sums.assign(matrix_.rows(), Rgb(0));
    return run_row_groups(row_groups_, {options, timer, deadline, "rows"}, sums, pool_,
                          [&](std::size_t group, Workspace& w) {
                            const Index i = row_groups_[group][0];
                            const std::vector<Index> rows(w.columns.size(), i);
                            w.reader->entries(rows, w.columns, w.values);
                            Rgb sum;
                            for (const Rgb v : w.values) sum += v;
                            sums[i] = sum;
                            ++w.row_groups;
                            if (after_group) after_group(group);
                          });
  }
  std::size_t units_run() const {
    std::size_t n = 0;
    pool_.for_each([&](const Workspace& w) { n += w.row_groups; });
    return n;
  }
  const RowGroups& row_groups() const { return row_groups_; }

  std::function<void(std::size_t)> after_group;

 private:
  RowGroups row_groups_;
  const DenseMatrix& matrix_;
  WorkspacePool<Workspace> pool_;
};

TEST(RowGroupPass, AnyThreadsGiveTheSameBitsAndEveryUnitOnce) {
  const auto m = matrix::low_rank_matrix({400, 60, 1}, 4);
  std::vector<Rgb> first;
  for (const int threads : {1, 2, 4})
    with_threads(threads, [&] {
      RowSums pass(m);
      std::vector<Rgb> sums;
      const RowGroupResult result = pass.run({}, sums);
      EXPECT_EQ(result.done, m.rows());
      EXPECT_EQ(pass.units_run(), m.rows());
      EXPECT_FALSE(result.cancelled || result.out_of_time);
      if (first.empty()) first = sums;
      EXPECT_EQ(sums, first);
    });
  EXPECT_LT(relative_difference(first, m.exact_sums()), 1e-6);
}

TEST(RowGroupPass, BeginningsAreSpreadEvenly) {
  for (const std::size_t n : {1u, 5u, 64u, 1000u, 4096u}) {
    const auto order = coarse_to_fine(n);
    EXPECT_EQ(std::set<std::uint32_t>(order.begin(), order.end()).size(), n);
    // A beginning of 2^-b of the row groups leaves gaps of no more than 2^b: strides are halved in turn.
    for (std::size_t gap = 1; gap <= 64 && n % 64 == 0; gap *= 2) {
      std::vector<std::uint32_t> beginning(order.begin(),
                                           order.begin() + static_cast<std::ptrdiff_t>(n / gap));
      std::sort(beginning.begin(), beginning.end());
      for (std::size_t k = 1; k < beginning.size(); ++k) EXPECT_EQ(beginning[k] - beginning[k - 1], gap);
    }
  }
}

TEST(RowGroupPass, CancellingKeepsWhatIsFinishedAndFillsInTheRest) {
  const auto m = matrix::clustered_matrix({320, 20, 1}, 3);
  const auto exact = m.exact_sums();
  std::atomic<bool> cancel{false};
  RunOptions options;
  options.sinks.cancel = &cancel;
  with_threads(1, [&] {
    RowSums pass(m);
    std::size_t count = 0;
    pass.after_group = [&](std::size_t) { cancel = ++count == 5; };
    std::vector<Rgb> sums;
    const RowGroupResult result = pass.run(options, sums);
    EXPECT_TRUE(result.cancelled);
    EXPECT_EQ(result.done, 5u);
    // Rows 0, 64, …, 256 are done; a row takes the sum of the nearest of them, of two as near the earlier.
    for (std::size_t i = 0; i < m.rows(); ++i) {
      const std::size_t nearest = std::min<std::size_t>(256, (i + 31) / 64 * 64);
      EXPECT_LT(norm2(sums[i] - exact[nearest]), 1e-5f * norm2(exact[nearest])) << i;
    }
    Estimate estimate;
    note_stop(result, estimate);
    EXPECT_TRUE(estimate.interrupted);
    EXPECT_EQ(estimate.trace.notes.at("stopped"), "cancelled");
  });
}

TEST(RowGroupPass, CancelledBeforeTheFirstUnitNothingIsTouched) {
  const auto m = matrix::clustered_matrix({10, 20, 1}, 3);
  const std::atomic<bool> cancel{true};
  RunOptions options;
  options.sinks.cancel = &cancel;
  RowSums pass(m);
  std::vector<Rgb> sums;
  const RowGroupResult result = pass.run(options, sums);
  EXPECT_TRUE(result.cancelled);
  EXPECT_EQ(result.done, 0u);
  EXPECT_EQ(sums, std::vector<Rgb>(10, Rgb(0)));
}

TEST(RowGroupPass, PreviewsAreCompleteAndChangeNothing) {
  const auto m = matrix::low_rank_matrix({500, 40, 1}, 4);
  std::vector<Rgb> unwatched, watched;
  RowSums(m).run({}, unwatched);
  RunOptions options;
  std::vector<double> errors;
  std::vector<double> progress;
  options.on_estimate = [&](std::span<const Rgb> sums) {
    ASSERT_EQ(sums.size(), m.rows());
    for (const Rgb v : sums) EXPECT_FALSE(is_black(v));
    errors.push_back(relative_difference(sums, m.exact_sums()));
  };
  options.sinks.progress = [&](const char* phase, double fraction) {
    EXPECT_STREQ(phase, "rows");
    progress.push_back(fraction);
  };
  RowSums(m).run(options, watched);
  EXPECT_EQ(watched, unwatched);
  ASSERT_EQ(errors.size(), 5u);  // at 1/16, 1/8, 1/4, 1/2 and 3/4
  EXPECT_TRUE(std::is_sorted(errors.rbegin(), errors.rend()));
  EXPECT_TRUE(std::is_sorted(progress.begin(), progress.end()));
  EXPECT_EQ(progress.back(), 1.0);
}

TEST(RowGroupPass, ADeadlineThatIsOverLeavesOneUnitAndItsChoiceIsRepeated) {
  const auto m = matrix::low_rank_matrix({200, 40, 1}, 4);
  TimedChoices written;
  RunOptions options;
  options.time_seconds = 1e-9;
  options.choices = &written;
  std::vector<Rgb> sums;
  RowGroupResult result;
  with_threads(1, [&] { result = RowSums(m).run(options, sums, options.time_seconds); });
  EXPECT_TRUE(result.out_of_time);
  EXPECT_EQ(result.done, 1u);
  EXPECT_EQ(sums, std::vector<Rgb>(200, sums[0]));
  Estimate estimate;
  note_stop(result, estimate);
  EXPECT_FALSE(estimate.interrupted);
  EXPECT_EQ(estimate.trace.notes.at("stopped"), "time budget");

  // The clock is not asked again: a deadline in a thousand years stops it at the same row group.
  TimedChoices repeated(written.made());
  options.choices = &repeated;
  std::vector<Rgb> again;
  EXPECT_EQ(RowSums(m).run(options, again, 3e10).done, 1u);
  EXPECT_EQ(again, sums);
}

TEST(RowGroupPass, AFailureEndsThePassAndIsPassedOn) {
  const auto m = matrix::low_rank_matrix({200, 4, 1}, 4);
  RowSums pass(m);
  pass.after_group = [](std::size_t group) {
    if (group == 32) throw std::runtime_error("group 32");
  };
  std::vector<Rgb> sums;
  EXPECT_THROW(pass.run({}, sums), std::runtime_error);
}

TEST(RowGroups, PixelsHoldTheirRowsInOrder) {
  DenseMatrix m(6, 1, std::vector<Rgb>(6, Rgb(1)));
  m.pixel = {{0.5f, 0.5f}, {-0.5f, 0.5f}, {1.5f, 0.2f}, {0.9f, 0.1f}, {-0.9f, 0.9f}, {1.5f, 1.5f}};
  const RowGroups row_groups = RowGroups::pixels(m);
  const std::vector<std::vector<Index>> expected{{0, 3}, {1, 4}, {2}, {5}};
  ASSERT_EQ(row_groups.size(), expected.size());
  for (std::size_t u = 0; u < row_groups.size(); ++u)
    EXPECT_EQ(std::vector<Index>(row_groups[u].begin(), row_groups[u].end()), expected[u]);
  m.pixel.clear();
  EXPECT_EQ(RowGroups::pixels(m).size(), 6u);
  EXPECT_EQ(RowGroups::single(0).size(), 0u);
}

TEST(RowGroups, MustCoverWhatTheyAreGiven) {
  EXPECT_THROW(RowGroups({0, 1}, {0, 1}), InternalError);
  EXPECT_THROW(RowGroups({0, 1}, {0, 0, 2}), InternalError);
  EXPECT_THROW(RowGroups({}, {}), InternalError);
}

}  // namespace
}  // namespace lumirank::methods
