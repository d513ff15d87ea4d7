#include "linalg/graph_partition.h"

#include <metis.h>

#include <algorithm>
#include <mutex>
#include <numeric>
#include <type_traits>

#include "base/error.h"

namespace lumirank::linalg {

static_assert(std::is_same_v<idx_t, std::int32_t>, "METIS was built with 64-bit indices");

Graph graph_of(std::size_t nodes, std::vector<Edge> edges) {
  std::erase_if(edges, [](const Edge& e) { return e.a == e.b; });
  const std::size_t given = edges.size();
  for (std::size_t k = 0; k < given; ++k) edges.push_back({edges[k].b, edges[k].a, edges[k].weight});
  std::sort(edges.begin(), edges.end(), [](const Edge& x, const Edge& y) {
    return std::tie(x.a, x.b, y.weight) < std::tie(y.a, y.b, x.weight);
  });
  edges.erase(std::unique(edges.begin(), edges.end(),
                          [](const Edge& x, const Edge& y) { return x.a == y.a && x.b == y.b; }),
              edges.end());
  Graph graph;
  graph.first.assign(nodes + 1, 0);
  for (const Edge& e : edges) {
    ++graph.first[e.a + 1];
    graph.neighbor.push_back(static_cast<std::int32_t>(e.b));
    graph.weight.push_back(e.weight);
  }
  std::partial_sum(graph.first.begin(), graph.first.end(), graph.first.begin());
  return graph;
}

std::vector<std::uint32_t> partition_graph(const Graph& graph, std::size_t parts, std::uint64_t seed) {
  const std::size_t nodes = graph.nodes();
  std::vector<std::uint32_t> part(nodes, 0);
  if (parts < 2) return part;
  if (nodes <= parts || graph.neighbor.empty()) {
    for (std::size_t v = 0; v < nodes; ++v) part[v] = static_cast<std::uint32_t>(v * parts / nodes);
    return part;
  }
  // METIS takes what it reads as not constant.
  auto first = graph.first, neighbor = graph.neighbor, weight = graph.weight;
  idx_t options[METIS_NOPTIONS];
  METIS_SetDefaultOptions(options);
  options[METIS_OPTION_NUMBERING] = 0;
  options[METIS_OPTION_SEED] = static_cast<idx_t>(seed & 0x7fffffff);
  auto count = static_cast<idx_t>(nodes), wanted = static_cast<idx_t>(parts);
  idx_t constraints = 1, cut = 0;
  std::vector<idx_t> found(nodes);
  static std::mutex one_at_a_time;
  const std::lock_guard lock(one_at_a_time);
  const auto partition = parts == 2 ? METIS_PartGraphRecursive : METIS_PartGraphKway;
  const int status = partition(&count, &constraints, first.data(), neighbor.data(), nullptr, nullptr,
                               weight.data(), &wanted, nullptr, nullptr, options, &cut, found.data());
  if (status != METIS_OK)
    throw InternalError("METIS cannot partition a graph of " + std::to_string(nodes) + " nodes (status " +
                        std::to_string(status) + ")");
  for (std::size_t v = 0; v < nodes; ++v) part[v] = static_cast<std::uint32_t>(found[v]);
  return part;
}

}  // namespace lumirank::linalg
