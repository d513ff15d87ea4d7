// Clusters' columns at rows, a slice of neighboring rows at a time: a slice's rows are set once for all
// columns, and its sums stay in a core's cache.
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <vector>

#include "base/parallel.h"
#include "matrix/entry_reader.h"
#include "matrix/lighting_matrix.h"
#include "methods/tensor_clustering/cluster_reader.h"

namespace lumirank::methods {

// body(reader, begin, end), in parallel: the reader has the rows of that range set.
template <typename Body>
matrix::Cost each_slice(const matrix::LightingMatrix& matrix, std::span<const matrix::Index> rows,
                        const Body& body) {
  constexpr std::size_t kSlice = 512;
  return parallel_sum(rows.size(), kSlice, matrix::Cost{}, [&](std::size_t begin, std::size_t end) {
    const std::unique_ptr<matrix::EntryReader> reader = matrix.reader();
    reader->set_rows(rows.subspan(begin, end - begin));
    return body(*reader, begin, end);
  });
}

// Σ scale · column of clusters at each of the rows. Adds to `spent`.
inline std::vector<Rgb> sums_at(const matrix::LightingMatrix& matrix, std::span<const matrix::Index> rows,
                                std::span<const ClusterLight> clusters, matrix::Cost& spent) {
  std::vector<Rgb> sums(rows.size(), Rgb(0));
  spent += each_slice(matrix, rows, [&](matrix::EntryReader& reader, std::size_t begin, std::size_t end) {
    matrix::Cost cost;
    ClusterReader read_clusters(reader, rows.subspan(begin, end - begin), matrix.rows());
    std::vector<Rgb> values(end - begin);
    for (const ClusterLight& c : clusters) {
      cost += read_clusters.read(c, values);
      for (std::size_t i = begin; i < end; ++i) sums[i] += c.scale * values[i - begin];
    }
    return cost;
  });
  return sums;
}

}  // namespace lumirank::methods
