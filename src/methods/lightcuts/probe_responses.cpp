#include "methods/lightcuts/probe_responses.h"

#include <algorithm>
#include <cmath>

namespace lumirank::methods {

namespace {
constexpr std::size_t kLights = 32;
}

// The representatives of a cut in which the node of most power is refined first.
ProbeResponses::ProbeResponses(const LightTree& tree) {
  std::vector<LightTree::Node> cut(tree.roots().begin(), tree.roots().end());
  while (cut.size() < kLights) {
    auto strongest = cut.end();
    for (auto n = cut.begin(); n != cut.end(); ++n)
      if (!tree.is_leaf(*n) && (strongest == cut.end() || tree.power(*n) > tree.power(*strongest)))
        strongest = n;
    if (strongest == cut.end()) break;
    const LightTree::Node node = *strongest;
    *strongest = tree.left(node);
    cut.push_back(tree.right(node));
  }
  for (const LightTree::Node node : cut) lights_.push_back(tree.representative(node));
}

void ProbeResponses::measure(std::span<const matrix::Index> rows, matrix::EntryReader& reader) {
  responses_.assign(rows.size() * lights_.size(), 0);
  values_.resize(rows.size());
  reader.set_rows(rows);
  for (std::size_t l = 0; l < lights_.size(); ++l) {
    reader.column(lights_[l], values_, matrix::Part::unoccluded);
    for (std::size_t k = 0; k < rows.size(); ++k) responses_[k * lights_.size() + l] = luminance(values_[k]);
  }
  for (std::size_t k = 0; k < rows.size(); ++k) {
    const auto row = std::span(responses_).subspan(k * lights_.size(), lights_.size());
    double squares = 0;
    for (const float v : row) squares += static_cast<double>(v) * static_cast<double>(v);
    const double size = std::sqrt(squares);
    for (float& v : row) v = size > 0 ? static_cast<float>(static_cast<double>(v) / size) : 0.0f;
  }
}

float ProbeResponses::similarity(std::size_t a, std::size_t b) const {
  const std::size_t n = lights_.size();
  float cosine = 0, of_a = 0, of_b = 0;
  for (std::size_t l = 0; l < n; ++l) {
    const float x = responses_[a * n + l], y = responses_[b * n + l];
    cosine += x * y, of_a += x, of_b += y;
  }
  return of_a == 0 && of_b == 0 ? 1.0f : cosine;
}

}  // namespace lumirank::methods
