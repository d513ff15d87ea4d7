#include "transport/lights/gather_samples.h"

#include <algorithm>
#include <cmath>
#include <unordered_map>

#include "base/error.h"
#include "base/parallel.h"
#include "base/random.h"
#include "base/sequence.h"
#include "transport/lights/halves.h"
#include "world/surface.h"

namespace lumirank::transport {
namespace {

// Where light is of no use to anything that is seen, samples are as dense as this part of the mean.
constexpr double kLeastDensity = 0.05;
// Places that are drawn for each that stays.
constexpr double kCandidates = 3;
// Triangles with more than this part of all area are cut, so that use is asked for in parts of them.
constexpr double kLargePart = 1.0 / 4096;
constexpr int kMaxCuts = 5;  // each into four

// A part of a primitive: three corners in barycentric coordinates, or a whole segment of a fiber.
struct GatherPiece {
  Vec2f a{0, 0}, b{1, 0}, c{0, 1};
  double fraction = 1;  // of the primitive

  Vec2f center() const { return (a + b + c) * (1.0f / 3); }
  Vec2f at(Vec2f u) const {
    const float root = std::sqrt(u.x);
    return a * (1 - root) + b * (root * (1 - u.y)) + c * (root * u.y);
  }
};

// Σ over a shape: of areas, and of areas times use.
struct ShapeSum {
  double area = 0, use = 0;
  ShapeSum operator+(const ShapeSum& o) const { return {area + o.area, use + o.use}; }
};

class GatherPlacer {
 public:
  GatherPlacer(std::span<const GatherMoment> moments, std::uint64_t seed) : moments_(moments), seed_(seed) {
    find_shapes();
  }

  GatherSamples place(std::size_t count) {
    GatherSamples out;
    for (const Shape& s : shapes_) out.shapes.push_back({s.id, s.primitives});
    std::vector<double> areas(shapes_.size());
    for_shapes([&](std::size_t s) {
      for (std::uint32_t p = 0; p < shapes_[s].primitives; ++p) areas[s] += area(s, p);
    });
    for (const double a : areas) total_area_ += a;
    if (!(total_area_ > 0) || count == 0) return out;
    std::vector<ShapeSum> sums(shapes_.size());
    for_shapes([&](std::size_t s) {
      visit(s, [&](std::uint32_t, const GatherPiece&, double area, double piece_use) {
        sums[s] = sums[s] + ShapeSum{area, area * piece_use};
      });
    });
    ShapeSum all;
    for (const ShapeSum& s : sums) all = all + s;
    floor_ = all.use > 0 ? kLeastDensity * all.use / all.area : 1.0;
    draw_candidates(sums, all, kCandidates * static_cast<double>(count));
    thin(static_cast<double>(count), out);
    return out;
  }

 private:
  struct Shape {
    std::uint64_t id = 0;
    std::size_t primitives = 0;
    bool fibers = false;
    std::vector<int> placement;  // at each moment; -1: it is not there
  };
  struct Candidate {
    std::uint32_t shape, primitive;
    Vec2f at;
    double fraction;  // of the primitive, over the candidates that its piece had to get
    double use;       // at the place over that of the piece
  };

  // Those of all moments, in the order in which they are met.
  void find_shapes() {
    std::unordered_map<std::uint64_t, std::size_t> known;
    for (std::size_t m = 0; m < moments_.size(); ++m) {
      const world::World& world = *moments_[m].world;
      for (std::size_t i = 0; i < world.placement_ids().size(); ++i) {
        const geometry::TriangleMesh& mesh = world.rays().mesh(world.rays().placements()[i].mesh);
        const auto [found, fresh] = known.try_emplace(world.placement_ids()[i], shapes_.size());
        if (fresh)
          shapes_.push_back({world.placement_ids()[i], mesh.primitive_count(), !mesh.fibers.empty(),
                             std::vector<int>(moments_.size(), -1)});
        Shape& s = shapes_[found->second];
        if (s.primitives == mesh.primitive_count()) s.placement[m] = static_cast<int>(i);
      }
    }
  }

  template <typename Body>
  void for_shapes(const Body& body) const {
    parallel_for(shapes_.size(), 1, [&](std::size_t begin, std::size_t end) {
      for (std::size_t s = begin; s < end; ++s) body(s);
    });
  }

  // The greatest of all moments.
  double area(std::size_t s, std::uint32_t primitive) const {
    double greatest = 0;
    for (std::size_t m = 0; m < moments_.size(); ++m)
      if (shapes_[s].placement[m] >= 0)
        greatest = std::max(
            greatest, world::primitive_area(*moments_[m].world,
                                            static_cast<std::uint32_t>(shapes_[s].placement[m]), primitive));
    return greatest;
  }

  // Of how much use light is that leaves a place, on its more useful side at its most useful moment.
  double use(std::size_t s, std::uint32_t primitive, Vec2f at) const {
    double greatest = 0;
    for (std::size_t m = 0; m < moments_.size(); ++m) {
      if (shapes_[s].placement[m] < 0) continue;
      if (!moments_[m].importance) return 1;
      const auto instance = static_cast<std::uint32_t>(shapes_[s].placement[m]);
      const world::World& world = *moments_[m].world;
      const geometry::Hit hit{0, instance, world.rays().placements()[instance].mesh, primitive,
                              shapes_[s].fibers ? Vec2f{at.x, 0} : at};
      const scatter::SurfacePoint point = world.surface(hit, {0, 0, 1}).point;
      const Vec3f n = point.shading.n;
      greatest = std::max(greatest, static_cast<double>(moments_[m].importance->at(point.position, n)));
      greatest = std::max(greatest, static_cast<double>(moments_[m].importance->at(point.position, -n)));
    }
    return greatest;
  }

  // body(primitive, piece, area, use at its middle), in order.
  template <typename Body>
  void visit(std::size_t s, const Body& body) const {
    for (std::uint32_t p = 0; p < shapes_[s].primitives; ++p) {
      const double whole = area(s, p);
      if (!(whole > 0)) continue;
      int cuts = 0;
      for (double part = whole; !shapes_[s].fibers && part > kLargePart * total_area_ && cuts < kMaxCuts;
           part /= 4)
        ++cuts;
      pieces(cuts, GatherPiece{}, [&](const GatherPiece& piece) {
        const Vec2f middle = shapes_[s].fibers ? Vec2f{0.5f, 0} : piece.center();
        body(p, piece, whole * piece.fraction, use(s, p, middle));
      });
    }
  }
  template <typename Body>
  static void pieces(int cuts, const GatherPiece& t, const Body& body) {
    if (cuts == 0) {
      body(t);
      return;
    }
    const Vec2f ab = (t.a + t.b) * 0.5f, bc = (t.b + t.c) * 0.5f, ca = (t.c + t.a) * 0.5f;
    for (const GatherPiece& part :
         {GatherPiece{t.a, ab, ca, t.fraction / 4}, GatherPiece{ab, t.b, bc, t.fraction / 4},
          GatherPiece{ca, bc, t.c, t.fraction / 4}, GatherPiece{bc, ca, ab, t.fraction / 4}})
      pieces(cuts - 1, part, body);
  }

  // Stratified along shapes, primitives and pieces by area and use, and within each piece evenly spread.
  void draw_candidates(const std::vector<ShapeSum>& sums, const ShapeSum& all, double wanted) {
    std::vector<double> before(shapes_.size() + 1, 0.0);
    const double density = wanted / (all.use + floor_ * all.area);
    for (std::size_t s = 0; s < shapes_.size(); ++s)
      before[s + 1] = before[s] + density * (sums[s].use + floor_ * sums[s].area);
    std::vector<std::vector<Candidate>> found(shapes_.size());
    const double shift = unit_double(hash_ids(seed_, Stage::gather_samples));
    for_shapes([&](std::size_t s) {
      double reached = before[s] + shift;
      visit(s, [&](std::uint32_t p, const GatherPiece& piece, double area, double piece_use) {
        const double rate = density * area * (piece_use + floor_);
        const auto first = static_cast<std::uint64_t>(reached);
        reached += rate;
        const auto n = static_cast<std::uint64_t>(reached) - first;
        const Sequence2 spread(seed_, Stage::gather_samples,
                               hash_ids(shapes_[s].id, Stage::gather_samples, p, first));
        for (std::uint64_t k = 0; k < n; ++k) {
          const Vec2f at = shapes_[s].fibers ? spread(k) : piece.at(spread(k));
          const double here = n == 1 || shapes_[s].fibers ? piece_use : use(s, p, at);
          found[s].push_back({static_cast<std::uint32_t>(s), p, at, piece.fraction / rate,
                              (here + floor_) / (piece_use + floor_)});
        }
      });
    });
    for (auto& part : found) candidates_.insert(candidates_.end(), part.begin(), part.end());
  }

  // Keeps of the candidates those whose turn it is, as often as they are of use.
  void thin(double wanted, GatherSamples& out) const {
    const auto kept = [&](double factor) {
      double sum = 0;
      for (const Candidate& c : candidates_) sum += std::min(1.0, factor * c.use);
      return sum;
    };
    double low = 0, high = 1;
    while (kept(high) < wanted && kept(high) < static_cast<double>(candidates_.size())) high *= 2;
    for (int step = 0; step < 50; ++step) {
      const double middle = 0.5 * (low + high);
      (kept(middle) > wanted ? high : low) = middle;
    }
    double reached = unit_double(hash_ids(seed_, Stage::gather_samples, 1));
    for (std::size_t k = 0; k < candidates_.size(); ++k) {
      const Candidate& c = candidates_[k];
      const double keep = std::min(1.0, high * c.use), before = std::floor(reached);
      reached += keep;
      if (!(std::floor(reached) > before)) continue;
      GatherSample sample;
      sample.id = hash_ids(seed_, Stage::gather_samples, 2, out.samples.size());
      sample.shape = c.shape, sample.primitive = c.primitive, sample.at = c.at;
      sample.part = static_cast<float>(c.fraction / keep);
      out.samples.push_back(sample);
    }
  }

  std::span<const GatherMoment> moments_;
  std::uint64_t seed_;
  std::vector<Shape> shapes_;
  std::vector<Candidate> candidates_;
  double total_area_ = 0, floor_ = 0;
};

}  // namespace

GatherSamples place_gather_samples(std::span<const GatherMoment> moments, std::uint64_t seed,
                                   std::size_t count) {
  if (moments.empty()) throw InternalError("gather samples need a moment");
  return GatherPlacer(moments, seed).place(count);
}

}  // namespace lumirank::transport
