#include "transport/rows/gathered_receivers.h"

#include <algorithm>
#include <vector>

#include "base/error.h"
#include "base/parallel.h"
#include "base/random.h"
#include "base/sample_stream.h"
#include "scatter/closure.h"
#include "transport/rows/eye_chain.h"

namespace lumirank::transport {
namespace {

constexpr std::size_t kRowsPerPiece = 1024;
// Lobes that weigh less are followed in proportion to their weight.
constexpr float kLightLobe = 0.2f;

struct GatheredPiece {
  std::vector<EyeVertex> vertices;
  scatter::ClosurePool pool;
};

class Gathering {
 public:
  Gathering(const Receivers& rows, const GatherSettings& settings) : rows_(rows), settings_(settings) {}

  void follow(std::size_t i, EyeChain& chain, GatheredPiece& piece) const {
    if (rows_.closure[i] == Receivers::kLambertian) return;
    if (settings_.max_depth >= 0 && rows_.depth[i] + 2 > settings_.max_depth) return;
    const scatter::Closure sharp = scatter::sharp_part(rows_.closure_at(i), settings_.below);
    if (sharp.count == 0) return;
    SampleStream random(settings_.seed, Stage::gathered, rows_.key(i), settings_.pass);
    const auto [u_lobe, u_survival] = random.next_2d();
    const auto next =
        scatter::sample(sharp, rows_.wo[i], u_lobe, random.next_2d(), scatter::Lobes::non_delta);
    if (!next) return;
    const Rgb weight = rows_.weight[i] * next->weight;
    const float survival = std::min(1.0f, max_component(weight) / kLightLobe);
    if (!(u_survival < survival)) return;
    EyeVertex from;
    from.weight = weight * (1 / survival);
    from.id = hash_ids(rows_.id[i], Stage::gathered);
    from.sample = rows_.sample[i];
    from.depth = rows_.depth[i];
    const geometry::Ray ray{world::World::offset_origin(rows_.position[i], rows_.ng[i], next->wi), next->wi};
    Rng rng(settings_.seed, Stage::gathered, rows_.id[i], ~settings_.pass);
    chain.follow_from(from, ray, rng, piece.vertices, piece.pool);
  }

 private:
  const Receivers& rows_;
  const GatherSettings& settings_;
};

}  // namespace

Receivers with_gathered(const world::World& world, Receivers rows, const GatherSettings& settings,
                        const Sinks& sinks) {
  const Gathering gathering(rows, settings);
  std::vector<GatheredPiece> pieces((rows.size() + kRowsPerPiece - 1) / kRowsPerPiece);
  parallel_for(rows.size(), kRowsPerPiece, [&](std::size_t begin, std::size_t end) {
    if (sinks.cancelled()) return;
    EyeChain chain(world, {settings.max_depth});
    GatheredPiece& piece = pieces[begin / kRowsPerPiece];
    for (std::size_t i = begin; i < end; ++i) gathering.follow(i, chain, piece);
  });
  if (sinks.cancelled()) throw Cancelled();
  std::size_t to = rows.size();
  for (const GatheredPiece& piece : pieces) rows.gathered += piece.vertices.size();
  rows.resize(to + rows.gathered, !rows.surface.empty());
  for (GatheredPiece& piece : pieces) {
    const std::uint32_t first_closure = rows.closures.append(piece.pool);
    for (EyeVertex& v : piece.vertices) {
      if (v.closure != Receivers::kLambertian) v.closure += first_closure;
      rows.set(to++, v);
    }
    piece = {};
  }
  rows.closures.shrink();
  return rows;
}

}  // namespace lumirank::transport
