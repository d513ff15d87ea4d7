// Whether refitting Embree's structure would pay where only vertices move. A cloth deforms; for some of its
// frames, milliseconds to bring a structure up to date and millions of shadow rays a second through it: built
// anew by each quality, or built in frame 0 and refitted since, as it is and as an instance in a scene of its
// own. Above so many rays per frame building by HIGH (the renderer's way) costs less in all than the other;
// also what the other costs more at 20 and at 200 million rays. Rays are those of columns: packets of 16
// neighboring receivers, half of them on the cloth, to one light, pairs that face away left out. Packets are
// traced as coherent, but not where there are instances (geometry/embree.h); "HIGH, loose" tells what that
// alone does. Embree has one thread, and times are CPU time. All kinds take turns in one run.
//
//   bench_refit [motion]...     wave: it travels half its length; twist: by 180 degrees; unroll: from a
//                               spiral to a plane. All of them if none is given.
//   environment: BENCH_TRIANGLES (15000), BENCH_RAYS (2000000: of each frame and kind), BENCH_ROUNDS (2:
//   builds of each frame and kind, of which the shortest counts), BENCH_BEAMS (0: thin slanted boxes about
//   the cloth, which do not move)
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <string>
#include <vector>

#include "base/error.h"
#include "base/random.h"
#include "base/vec.h"
#include "bench_scene.h"
#include "geometry/embree.h"

namespace {

using namespace lumirank;
using bench::setting;
namespace embree = geometry::embree;

double cpu_ms() { return 1e3 * static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

// The cloth in a moment from 0 to 1, about 2×2 large. Its corners are (0, 0) and (1, 1).
class Cloth {
 public:
  Cloth(const std::string& motion, float moment) : motion_(motion), moment_(moment) {
    if (motion == "unroll")
      unroll();
    else if (motion != "wave" && motion != "twist")
      throw InputError("no such motion: " + motion, "wave, twist or unroll");
  }

  Vec3f at(float u, float v) const {
    const float x = 2 * u - 1, z = 2 * v - 1;
    if (motion_ == "wave")
      return {x, 0.15f * std::sin(kPi * (3 * x + moment_)) + 0.05f * std::sin(kPi * (4 * z + x)), z};
    if (motion_ == "twist") {
      const float angle = kPi * moment_ * u, y = 0.05f * std::sin(kPi * (3 * x + 2 * z));
      return {x, y * std::cos(angle) + z * std::sin(angle), z * std::cos(angle) - y * std::sin(angle)};
    }
    const float place = u * static_cast<float>(curve_.size() - 1);
    const std::size_t k = std::min(static_cast<std::size_t>(place), curve_.size() - 2);
    const Vec3f p = lerp(curve_[k], curve_[k + 1], place - static_cast<float>(k));
    return {p.x, p.y + 0.02f * std::sin(kPi * 3 * z), z};
  }

  // Of length 1, on the side of something above the cloth and before it.
  Vec3f normal(float u, float v) const {
    const float h = 1e-3f;
    const Vec3f n = normalize(cross(at(u, v + h) - at(u, v - h), at(u + h, v) - at(u - h, v)));
    return dot(n, Vec3f{0, 1.5f, 3} - at(u, v)) < 0 ? -n : n;
  }

 private:
  // A spiral of four turns 0.01 apart, whose curvature goes.
  void unroll() {
    const int steps = 16384;
    const double inner = 0.05, gap = 0.01, ds = 2.0 / steps;
    double x = 0, y = 0;
    for (int k = 0; k <= steps; ++k) {
      curve_.push_back({static_cast<float>(x), static_cast<float>(y), 0});
      const double turned =
          2 * kPiD / gap * (std::sqrt(inner * inner + gap * (k + 0.5) * ds / kPiD) - inner) * (1 - moment_);
      x += ds * std::cos(turned), y += ds * std::sin(turned);
    }
    for (Vec3f& p : curve_) p.x -= static_cast<float>(x / 2);
  }

  std::string motion_;
  float moment_;
  std::vector<Vec3f> curve_;
};

struct Grid {
  std::size_t side;
  std::vector<std::uint32_t> indices;
  explicit Grid(int triangles)
      : side(std::max<std::size_t>(1, static_cast<std::size_t>(std::lround(std::sqrt(triangles / 2.0))))) {
    const auto row = static_cast<std::uint32_t>(side + 1);
    for (std::uint32_t j = 0; j + 1 < row; ++j)
      for (std::uint32_t i = 0; i + 1 < row; ++i) {
        const std::uint32_t k = j * row + i;
        indices.insert(indices.end(), {k, k + 1, k + row, k + 1, k + row + 1, k + row});
      }
  }
  std::size_t triangles() const { return indices.size() / 3; }
  std::vector<Vec3f> vertices(const Cloth& cloth) const {
    std::vector<Vec3f> all;
    all.reserve((side + 1) * (side + 1) + 1);  // Embree may read a little more than it is told of
    const auto scale = 1 / static_cast<float>(side);
    for (std::size_t j = 0; j <= side; ++j)
      for (std::size_t i = 0; i <= side; ++i)
        all.push_back(cloth.at(static_cast<float>(i) * scale, static_cast<float>(j) * scale));
    return all;
  }
};

// What stands still.
struct Beams {
  std::vector<Vec3f> vertices;
  std::vector<std::uint32_t> indices;
  explicit Beams(int count) {
    Rng rng(2, Stage::benchmark);
    const auto random = [&] { return 2 * rng.next_float() - 1; };
    for (int k = 0; k < count; ++k) {
      const Vec3f center{1.8f * random(), 1.4f * random() + 0.4f, 1.8f * random()};
      const Vec3f along = normalize(Vec3f{random(), random(), random()});
      const Vec3f across = normalize(cross(along, Vec3f{0.3f, 0.5f, 0.8f}));
      const Vec3f axes[3] = {along * (0.2f + 0.5f * rng.next_float()), across * 0.01f,
                             cross(along, across) * 0.01f};
      const auto first = static_cast<std::uint32_t>(vertices.size());
      for (unsigned corner = 0; corner < 8; ++corner) {
        Vec3f p = center;
        for (unsigned a = 0; a < 3; ++a) p = corner >> a & 1 ? p + axes[a] : p - axes[a];
        vertices.push_back(p);
      }
      for (const unsigned side : {0x0132u, 0x4576u, 0x0154u, 0x2376u, 0x0264u, 0x1375u}) {
        const auto corner = [&](unsigned c) { return first + (side >> (4 * (3 - c)) & 7); };
        for (const unsigned c : {0u, 1u, 2u, 0u, 2u, 3u}) indices.push_back(corner(c));
      }
    }
    vertices.reserve(vertices.size() + 1);
  }
};

struct Device {
  long long allocated = 0;  // what has been given back since counts too
  embree::Device handle{rtcNewDevice("threads=1")};
  Device() {
    const auto count = [](void* user, ssize_t bytes, bool) {
      static_cast<Device*>(user)->allocated += std::max<ssize_t>(bytes, 0);
      return true;
    };
    rtcSetDeviceMemoryMonitorFunction(handle.get(), count, this);
  }
};

struct Inputs {
  RTCDevice device;
  const Grid& grid;
  const Beams& beams;
};

embree::Geometry triangles(RTCDevice device, const std::vector<std::uint32_t>& indices,
                           const std::vector<Vec3f>& vertices, RTCBuildQuality quality) {
  embree::Geometry geometry(rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE));
  rtcSetGeometryBuildQuality(geometry.get(), quality);
  rtcSetSharedGeometryBuffer(geometry.get(), RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, indices.data(), 0,
                             3 * sizeof(std::uint32_t), indices.size() / 3);
  rtcSetSharedGeometryBuffer(geometry.get(), RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, vertices.data(), 0,
                             sizeof(Vec3f), vertices.size());
  return geometry;
}

void attach(RTCScene scene, const embree::Geometry& geometry) {
  rtcCommitGeometry(geometry.get());
  rtcAttachGeometry(scene, geometry.get());
}

embree::Geometry attach_instance(RTCDevice device, RTCScene scene, RTCScene of) {
  embree::Geometry geometry(rtcNewGeometry(device, RTC_GEOMETRY_TYPE_INSTANCE));
  rtcSetGeometryInstancedScene(geometry.get(), of);
  const float rows[12] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};
  rtcSetGeometryTransform(geometry.get(), 0, RTC_FORMAT_FLOAT3X4_ROW_MAJOR, rows);
  attach(scene, geometry);
  return geometry;
}

embree::Scene build_anew(const Inputs& in, const std::vector<Vec3f>& vertices, RTCBuildQuality quality) {
  embree::Scene scene(rtcNewScene(in.device));
  rtcSetSceneBuildQuality(scene.get(), quality);
  attach(scene.get(), triangles(in.device, in.grid.indices, vertices, quality));
  if (!in.beams.indices.empty())
    attach(scene.get(), triangles(in.device, in.beams.indices, in.beams.vertices, quality));
  rtcCommitScene(scene.get());
  return scene;
}

// What is kept from frame to frame. Only a scene of low quality keeps a structure for each geometry, and only
// such ones can be refitted; it is the geometries' quality then that counts. What stands still is one of them
// in `flat`, and an instance of high quality in `top`.
struct Refitted {
  std::vector<Vec3f> vertices;  // what `cloth` shares
  embree::Scene flat, alone, still, top;
  embree::Geometry cloth, instance;
  double first_ms;

  Refitted(const Inputs& in, std::vector<Vec3f> start) : vertices(std::move(start)) {
    const bool beams = !in.beams.indices.empty();
    cloth = triangles(in.device, in.grid.indices, vertices, RTC_BUILD_QUALITY_REFIT);
    alone = dynamic_scene(in.device);
    attach(alone.get(), cloth);
    const double begin = cpu_ms();
    rtcCommitScene(alone.get());
    first_ms = cpu_ms() - begin;
    if (beams) {
      flat = dynamic_scene(in.device);
      attach(flat.get(), cloth);
      attach(flat.get(), triangles(in.device, in.beams.indices, in.beams.vertices, RTC_BUILD_QUALITY_MEDIUM));
      rtcCommitScene(flat.get());
    }
    top.reset(rtcNewScene(in.device));
    rtcSetSceneBuildQuality(top.get(), RTC_BUILD_QUALITY_HIGH);
    instance = attach_instance(in.device, top.get(), alone.get());
    if (beams) {
      still.reset(rtcNewScene(in.device));
      rtcSetSceneBuildQuality(still.get(), RTC_BUILD_QUALITY_HIGH);
      attach(still.get(), triangles(in.device, in.beams.indices, in.beams.vertices, RTC_BUILD_QUALITY_HIGH));
      rtcCommitScene(still.get());
      attach_instance(in.device, top.get(), still.get());
    }
    rtcCommitScene(top.get());
  }
  RTCScene flat_scene() const { return (flat ? flat : alone).get(); }

  void move(const std::vector<Vec3f>& now) {
    std::copy(now.begin(), now.end(), vertices.begin());
    rtcUpdateGeometryBuffer(cloth.get(), RTC_BUFFER_TYPE_VERTEX, 0);
    rtcCommitGeometry(cloth.get());
  }
  void refit_flat() { rtcCommitScene(flat_scene()); }
  void refit_top() {
    rtcCommitScene(alone.get());
    rtcCommitGeometry(instance.get());
    rtcCommitScene(top.get());
  }

 private:
  static embree::Scene dynamic_scene(RTCDevice device) {
    embree::Scene scene(rtcNewScene(device));
    rtcSetSceneBuildQuality(scene.get(), RTC_BUILD_QUALITY_LOW);
    rtcSetSceneFlags(scene.get(), RTC_SCENE_FLAG_DYNAMIC);
    return scene;
  }
};

struct Receivers {
  std::vector<Vec3f> position, normal;

  // Tiles of 4×4 neighbors on the cloth and on a floor below it.
  explicit Receivers(const Cloth& cloth) {
    const int side = 256;
    for (const bool floor : {false, true})
      for (int tile = 0; tile < side * side / 16; ++tile)
        for (int k = 0; k < 16; ++k) {
          const float u =
              (static_cast<float>(tile % (side / 4) * 4 + k % 4) + 0.5f) / static_cast<float>(side);
          const float v =
              (static_cast<float>(tile / (side / 4) * 4 + k / 4) + 0.5f) / static_cast<float>(side);
          normal.push_back(floor ? Vec3f{0, 1, 0} : cloth.normal(u, v));
          const Vec3f p = floor ? Vec3f{4 * u - 2, -1.2f, 4 * v - 2} : cloth.at(u, v);
          position.push_back(p + normal.back() * 1e-3f);
        }
  }
};

// On the walls of a box about the cloth, a third on the cloth itself.
Vec3f random_light(const Cloth& cloth, std::uint64_t number) {
  Rng rng(1, Stage::benchmark, number);
  const Vec2f at = rng.next_2d();
  if (number % 3 == 0) return cloth.at(at.x, at.y) + cloth.normal(at.x, at.y) * 1e-3f;
  const float a = 4 * at.x - 2, b = 4 * at.y - 2;
  switch (rng.next_below(5)) {
    case 0:
      return {-2, b * 0.8f + 0.4f, a};
    case 1:
      return {2, b * 0.8f + 0.4f, a};
    case 2:
      return {a, b * 0.8f + 0.4f, -2};
    case 3:
      return {a, b * 0.8f + 0.4f, 2};
    default:
      return {a, 2, b};
  }
}

// The pairs of one light that do not face away.
struct Column {
  Vec3f light;
  std::vector<float> x, y, z;
  std::size_t count;

  Column(const Receivers& receivers, Vec3f to) : light(to) {
    for (std::size_t i = 0; i < receivers.position.size(); ++i) {
      const Vec3f p = receivers.position[i];
      if (dot(receivers.normal[i], light - p) > 0) x.push_back(p.x), y.push_back(p.y), z.push_back(p.z);
    }
    count = x.size();
    for (auto* v : {&x, &y, &z}) v->resize((count + 15) / 16 * 16, v->empty() ? 0 : v->back());
  }
};

struct Traced {
  std::vector<double> ns;  // of a ray, by turn
  std::uint64_t rays = 0, occluded = 0;
  double ms = 0;
  double ns_per_ray() const { return 1e6 * ms / static_cast<double>(rays); }
};

// By how much a ray costs more than `than`, and its standard error.
struct More {
  double share, error;
  More(const Traced& a, const Traced& than) : share(a.ns_per_ray() / than.ns_per_ray() - 1) {
    double sum = 0, squares = 0;
    const auto n = static_cast<double>(a.ns.size());
    for (std::size_t k = 0; k < a.ns.size(); ++k) {
      const double ratio = a.ns[k] / than.ns[k];
      sum += ratio, squares += ratio * ratio;
    }
    error = std::sqrt(std::max(0.0, squares / n - sum * sum / (n * n)) / std::max(1.0, n - 1));
  }
};

void trace(RTCScene scene, bool coherent, const Column& column, Traced& sum) {
  const double begin = cpu_ms();
  embree::Context context;
  embree::initialize(context);
  RTCRay16 rays;
  alignas(64) int valid[16];
  const float ends = 1e-4f;
  for (std::size_t at = 0; at < column.count; at += 16) {
    for (unsigned k = 0; k < 16; ++k) {
      const float x = column.x[at + k], y = column.y[at + k], z = column.z[at + k];
      rays.org_x[k] = x, rays.org_y[k] = y, rays.org_z[k] = z;
      rays.dir_x[k] = column.light.x - x, rays.dir_y[k] = column.light.y - y,
      rays.dir_z[k] = column.light.z - z;
      rays.tnear[k] = ends, rays.tfar[k] = 1 - ends, rays.time[k] = 0;
      rays.mask[k] = 0xffffffffu, rays.id[k] = k, rays.flags[k] = 0;
      valid[k] = at + k < column.count ? -1 : 0;
    }
    embree::occluded16(valid, scene, context, rays, coherent);
    for (unsigned k = 0; k < 16; ++k) sum.occluded += unsigned{valid[k] != 0} & unsigned{rays.tfar[k] < 0};
  }
  sum.rays += column.count;
  sum.ms += cpu_ms() - begin;
}

enum Kind { high, medium, low, refitted, incoherent, instance, kinds };
constexpr const char* kNames[kinds] = {"HIGH", "MEDIUM", "LOW", "refit", "HIGH, loose", "refit, instance"};

void trace_all(const Cloth& cloth, RTCScene const scenes[kinds], Traced traced[kinds]) {
  const Receivers receivers(cloth);
  const auto enough = static_cast<std::uint64_t>(setting("BENCH_RAYS", 2000000));
  std::uint64_t light = 0;
  for (int turn = 0; traced[0].rays < enough; ++turn) {
    std::vector<Column> some;  // so many that each kind finds its own data in the caches
    while (some.size() < 2) some.emplace_back(receivers, random_light(cloth, light++));
    for (int k = 0; k < kinds; ++k) {
      const int kind = turn % 2 ? kinds - 1 - k : k;
      const Traced before = traced[kind];
      for (const Column& column : some) trace(scenes[kind], kind < incoherent, column, traced[kind]);
      Traced& now = traced[kind];
      now.ns.push_back(1e6 * (now.ms - before.ms) / static_cast<double>(now.rays - before.rays));
    }
  }
}

void print(Kind kind, const double* ms, const Traced* traced) {
  std::printf("    %-15s %8.2f ms  %6.2f million rays/s", kNames[kind], ms[kind],
              1e3 / traced[kind].ns_per_ray());
  const double high_ns = traced[high].ns_per_ray();
  if (kind != high) {
    const More more(traced[kind], traced[high]);
    const double saved_ms = ms[high] - ms[kind], lost_ns = more.share * high_ns;
    std::printf("  %+6.1f ± %.1f %% a ray", 100 * more.share, 100 * more.error);
    for (const double millions : {20.0, 200.0})
      std::printf(", %+.1f %% at %.0f",
                  100 * (millions * lost_ns - saved_ms) / (ms[high] + millions * high_ns), millions);
    if (more.share < 2 * more.error)
      std::printf("; rays show no loss");
    else if (saved_ms > 0)
      std::printf("; HIGH costs less from %.1f million rays on", saved_ms / lost_ns);
  }
  const auto differ = static_cast<double>(traced[kind].occluded) - static_cast<double>(traced[high].occluded);
  if (std::abs(differ) > 1e-4 * static_cast<double>(traced[high].rays))
    std::printf("; sees otherwise: %+.0f rays", differ);
  std::printf("\n");
}

void run_frame(Device& device, const Inputs& in, const Cloth& cloth, Refitted& kept) {
  const std::vector<Vec3f> vertices = in.grid.vertices(cloth);
  constexpr RTCBuildQuality qualities[] = {RTC_BUILD_QUALITY_HIGH, RTC_BUILD_QUALITY_MEDIUM,
                                           RTC_BUILD_QUALITY_LOW};
  embree::Scene anew[3];
  double ms[kinds];
  std::fill_n(ms, kinds, 1e30);
  long long bytes = 0;
  for (int round = 0; round < setting("BENCH_ROUNDS", 2); ++round) {
    double times[kinds];
    for (int k = 0; k < 3; ++k) {
      anew[k].reset();
      const double begin = cpu_ms();
      anew[k] = build_anew(in, vertices, qualities[k]);
      times[k] = cpu_ms() - begin;
    }
    const long long before = device.allocated;
    double begin = cpu_ms();
    kept.move(vertices);
    kept.refit_flat();
    times[refitted] = cpu_ms() - begin;
    bytes = device.allocated - before;
    begin = cpu_ms();
    kept.move(vertices);
    kept.refit_top();
    times[instance] = cpu_ms() - begin;
    times[incoherent] = times[high];
    for (int k = 0; k < kinds; ++k) ms[k] = std::min(ms[k], times[k]);
  }
  const RTCScene scenes[kinds] = {anew[0].get(),     anew[1].get(), anew[2].get(),
                                  kept.flat_scene(), anew[0].get(), kept.top.get()};
  Traced traced[kinds];
  trace_all(cloth, scenes, traced);
  std::printf("    %.1f %% of rays occluded; %.2f MB allocated to refit\n",
              100 * static_cast<double>(traced[high].occluded) / static_cast<double>(traced[high].rays),
              1e-6 * static_cast<double>(bytes));
  for (const Kind kind : {high, medium, low, refitted, incoherent, instance}) print(kind, ms, traced);
  std::fflush(stdout);
}

void run(const std::string& motion) {
  const Grid grid(setting("BENCH_TRIANGLES", 15000));
  const Beams beams(setting("BENCH_BEAMS", 0));
  Device device;
  const Inputs in{device.handle.get(), grid, beams};
  Refitted kept(in, grid.vertices(Cloth(motion, 0)));
  std::printf("%s, %zu triangles: %.2f ms to build what is refitted\n", motion.c_str(), grid.triangles(),
              kept.first_ms);
  for (const float moment : {0.1f, 0.3f, 1.0f}) {
    std::printf("  moment %.2f\n", static_cast<double>(moment));
    run_frame(device, in, Cloth(motion, moment), kept);
  }
}

}  // namespace

int main(int argc, char** argv) {
  std::vector<std::string> motions(argv + 1, argv + argc);
  if (motions.empty()) motions = {"wave", "twist", "unroll"};
  try {
    for (const std::string& motion : motions) run(motion);
  } catch (const std::exception& e) {
    std::fprintf(stderr, "%s\n", e.what());
    return EXIT_FAILURE;
  }
}
