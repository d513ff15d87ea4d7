#include "methods/lightcuts/reconstruction.h"

#include <algorithm>

namespace lumirank::methods {

namespace {
// Where the samples' sums are larger than this many times what the representative would give unoccluded, it
// tells nothing of the others.
constexpr float kTypical = 4;
// The most that texture or shading may brighten a node between two neighboring receivers.
constexpr float kMaxChange = 8;
}  // namespace

void CutSample::set(const Cut& cut, const LightTree& tree) {
  row = cut.row();
  sum = cut.total();
  const auto from = cut.nodes();
  nodes.resize(from.size());
  for (std::size_t k = from.size(); k-- > 0;) {
    Node& n = nodes[k];
    n.children = from[k].children;
    n.value = n.children != 0           ? nodes[n.children].value + nodes[n.children + 1].value
              : is_black(from[k].entry) ? Rgb(0)
                                        : tree.scaled(from[k].node).scale * from[k].entry;
  }
}

void ReconstructionCut::find(std::span<const CutSample* const> samples) {
  shaded_.clear(), interpolated_.clear(), stack_.clear();
  float min_total = luminance(samples[0]->sum);
  for (const CutSample* s : samples) min_total = std::min(min_total, luminance(s->sum));
  const float agreed = static_cast<float>(tolerance_) * min_total;
  for (std::uint32_t root = 0; root < tree_.roots().size(); ++root) {
    Visit visit{tree_.roots()[root], {}};
    visit.places.fill(root);
    stack_.push_back(visit);
  }
  while (!stack_.empty()) {
    const Visit visit = stack_.back();
    stack_.pop_back();
    float min_value = kInfinity, max_value = 0;
    bool on_cut = false;
    for (std::size_t s = 0; s < samples.size(); ++s) {
      const CutSample::Node& n = samples[s]->nodes[visit.places[s]];
      const float value = luminance(n.value);
      min_value = std::min(min_value, value), max_value = std::max(max_value, value);
      on_cut = on_cut || n.children == 0;
    }
    if (max_value == 0) continue;
    if (min_value > 0 && max_value - min_value < agreed) {
      Interpolated node{visit.node, {}};
      for (std::size_t s = 0; s < samples.size(); ++s)
        node.values[s] = samples[s]->nodes[visit.places[s]].value;
      interpolated_.push_back(node);
    } else if (on_cut) {
      shaded_.push_back({visit.node});
    } else {
      Visit left{tree_.left(visit.node), {}}, right{tree_.right(visit.node), {}};
      for (std::size_t s = 0; s < samples.size(); ++s) {
        left.places[s] = samples[s]->nodes[visit.places[s]].children;
        right.places[s] = left.places[s] + 1;
      }
      stack_.push_back(right);
      stack_.push_back(left);
    }
  }
}

Rgb interpolate(std::span<const float> weights, std::span<const Rgb> values, Rgb unoccluded_here,
                std::span<const Rgb> unoccluded_there, Rgb scale) {
  Rgb value, there;
  for (std::size_t s = 0; s < weights.size(); ++s) {
    value += weights[s] * values[s];
    there += weights[s] * unoccluded_there[s];
  }
  for (int c = 0; c < 3; ++c)
    if (value[c] <= kTypical * scale[c] * there[c] && there[c] > 0)
      value[c] *= std::min(unoccluded_here[c] / there[c], kMaxChange);
  return value;
}

}  // namespace lumirank::methods
