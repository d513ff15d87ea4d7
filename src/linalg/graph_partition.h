// Nodes of a weighted graph in parts of about the same size, so that edges between parts weigh little.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace lumirank::linalg {

// Undirected: an edge stands at both of its ends, the neighbors of node v in
// neighbor[first[v] … first[v + 1] − 1].
struct Graph {
  std::vector<std::int32_t> first{0}, neighbor, weight;  // weights ≥ 1
  std::size_t nodes() const { return first.size() - 1; }
};

struct Edge {
  std::uint32_t a, b;
  std::int32_t weight;
};
// Each edge in either direction; what is given twice counts once, with the larger weight; loops are left out.
Graph graph_of(std::size_t nodes, std::vector<Edge> edges);

// The part of each node, 0 … parts − 1; some may be empty. METIS: recursive bisection into two, k-way into
// more (Karypis and Kumar 1998, "A fast and high quality multilevel scheme for partitioning irregular
// graphs"). The same for the same seed; one call at a time, since METIS draws from the C library's random
// numbers, which all threads share. InternalError where METIS fails.
std::vector<std::uint32_t> partition_graph(const Graph& graph, std::size_t parts, std::uint64_t seed);

}  // namespace lumirank::linalg
