// How near the sum of columns comes to bare Embree: the same receiver-light pairs, once through
// SceneMatrix::accumulate and once through a loop that only traces their shadow rays, in packets of 16 with
// the coherent flag, prepared within the loop, pairs with a negative cosine at either end left out. Both in
// one run, alternating. Also single rows.
//
//   bench_accumulate [scene file] [benchmark options]
//   environment: BENCH_LIGHTS (100000), BENCH_COLUMNS (200), BENCH_WIDTH (800), BENCH_HEIGHT (600), BENCH_SPP
//   (4), BENCH_THREADS (all)
#include <benchmark/benchmark.h>

#include <algorithm>
#include <atomic>
#include <cstdio>
#include <cstring>

#include "base/lanes.h"
#include "base/parallel.h"
#include "base/random.h"
#include "base/timer.h"
#include "bench_scene.h"
#include "geometry/embree.h"
#include "transport/cpu/scene_matrix.h"

namespace {

using namespace lumirank;
using bench::setting;
using transport::LightKind;

// All that blocks, as one flat Embree scene.
struct BareScene {
  geometry::embree::Device device{rtcNewDevice(nullptr)};
  geometry::embree::Scene scene{rtcNewScene(device.get())};
  std::vector<geometry::TriangleMesh> meshes;

  explicit BareScene(const geometry::RayScene& rays) {
    rtcSetSceneBuildQuality(scene.get(), RTC_BUILD_QUALITY_HIGH);
    for (const geometry::Placement& p : rays.placements()) {
      if (p.blocking == geometry::Blocking::attenuating) continue;
      meshes.push_back(rays.mesh(p.mesh));
      for (Vec3f& v : meshes.back().positions) v = p.to_world.point(v);
      meshes.back().positions.reserve(meshes.back().positions.size() + 1);
    }
    for (const geometry::TriangleMesh& mesh : meshes) {
      if (mesh.indices.empty()) continue;
      geometry::embree::Geometry g(rtcNewGeometry(device.get(), RTC_GEOMETRY_TYPE_TRIANGLE));
      rtcSetSharedGeometryBuffer(g.get(), RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, mesh.positions.data(),
                                 0, sizeof(Vec3f), mesh.positions.size());
      rtcSetSharedGeometryBuffer(g.get(), RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, mesh.indices.data(), 0,
                                 3 * sizeof(std::uint32_t), mesh.triangle_count());
      rtcCommitGeometry(g.get());
      rtcAttachGeometry(scene.get(), g.get());
    }
    rtcCommitScene(scene.get());
  }
};

// Receivers as the bare loop reads them.
struct BareReceivers {
  static constexpr std::size_t kTile = 2048;
  std::vector<float> px, py, pz, nx, ny, nz, ox, oy, oz;
  explicit BareReceivers(const transport::Receivers& r) {
    const std::size_t padded = (r.size() + 15) / 16 * 16;
    for (auto* v : {&px, &py, &pz, &nx, &ny, &nz, &ox, &oy, &oz}) v->assign(padded, 0);
    for (std::size_t i = 0; i < r.size(); ++i) {
      const Vec3f p = r.position[i], n = r.normal[i], o = world::World::offset_origin(p, r.ng[i], n);
      px[i] = p.x, py[i] = p.y, pz[i] = p.z, nx[i] = n.x, ny[i] = n.y, nz[i] = n.z;
      ox[i] = o.x, oy[i] = o.y, oz[i] = o.z;
    }
  }
  std::size_t size() const { return px.size(); }
};

struct BareResult {
  std::uint64_t rays = 0, visible = 0;
  friend BareResult operator+(BareResult a, BareResult b) { return {a.rays + b.rays, a.visible + b.visible}; }
};

struct BareLight {
  bool far, one_sided;
  Vec3f position, normal, target;
};

BareResult trace_tile(const BareScene& bare, const BareReceivers& r, const BareLight& light,
                      std::size_t begin, std::size_t end) {
  // The survivors' origins, packed: looked up lane by lane they would cost a tenth of the loop.
  alignas(64) float x[BareReceivers::kTile + 16], y[BareReceivers::kTile + 16], z[BareReceivers::kTile + 16];
  std::size_t count = 0;
  const Lane3 light_p = splat(light.position), light_n = splat(light.normal), target = splat(light.target);
  for (std::size_t i = begin; i < end; i += 16) {
    const Lane3 n{load(&r.nx[i]), load(&r.ny[i]), load(&r.nz[i])};
    const Lane3 p{load(&r.px[i]), load(&r.py[i]), load(&r.pz[i])};
    const Lane3 w = light.far ? target : light_p - p;
    auto keep = dot(n, w) > Lane{};
    if (light.one_sided) keep &= dot(light_n, w) < Lane{};
    const std::uint32_t alive = bits(keep);
    append_lanes(alive, load(&r.ox[i]), x + count);
    append_lanes(alive, load(&r.oy[i]), y + count);
    append_lanes(alive, load(&r.oz[i]), z + count);
    count += static_cast<std::size_t>(__builtin_popcount(alive));
  }
  BareResult result;
  result.rays = count;
  for (float* v : {x, y, z}) std::fill_n(v + count, 15, count ? v[count - 1] : 0);
  RTCRay16 rays;
  alignas(64) int valid[16];
  for (std::size_t at = 0; at < count; at += 16) {
    const Lane3 o{load(x + at), load(y + at), load(z + at)};
    const Lane3 d = light.far ? target : target - o;
    store(rays.org_x, o.x), store(rays.org_y, o.y), store(rays.org_z, o.z);
    store(rays.dir_x, d.x), store(rays.dir_y, d.y), store(rays.dir_z, d.z);
    store(rays.tnear, splat(1e-4f));
    store(rays.tfar, splat(light.far ? kInfinity : 1 - 1e-4f));
    store(rays.time, Lane{});
    std::fill_n(rays.mask, 16, 0xffffffffu), std::fill_n(rays.id, 16, 0u), std::fill_n(rays.flags, 16, 0u);
    const LaneMask inside = kLaneNumbers < static_cast<int>(count - at);
    std::memcpy(valid, &inside, sizeof inside);
    geometry::embree::Context context;
    geometry::embree::initialize(context);
    geometry::embree::occluded16(valid, bare.scene.get(), context, rays, true);
    const std::uint32_t open = bits(inside & (load(rays.tfar) >= Lane{}));
    result.visible += static_cast<std::uint64_t>(__builtin_popcount(open));
  }
  return result;
}

BareResult trace_bare(const BareScene& bare, const BareReceivers& receivers,
                      const transport::VirtualLights& lights, std::span<const matrix::ScaledColumn> columns) {
  return parallel_sum(
      receivers.size(), BareReceivers::kTile, BareResult{}, [&](std::size_t begin, std::size_t end) {
        BareResult sum;
        for (const matrix::ScaledColumn& c : columns) {
          const LightKind kind = lights.kind[c.column];
          BareLight light;
          light.far = kind == LightKind::directional;
          light.one_sided = kind == LightKind::oriented || kind == LightKind::surface;
          light.position = lights.position[c.column];
          light.normal = lights.normal[c.column];
          light.target = light.far ? -light.normal
                                   : world::World::offset_origin(light.position, light.normal, light.normal);
          if (kind == LightKind::omni || kind == LightKind::spot) light.target = light.position;
          sum = sum + trace_tile(bare, receivers, light, begin, end);
        }
        return sum;
      });
}

double median(std::vector<double> v) {
  std::sort(v.begin(), v.end());
  return v[v.size() / 2];
}

struct Bench {
  bench::BenchScene scene;
  const world::World& world = scene.world;
  const transport::Receivers& receivers = scene.receivers;
  transport::VirtualLights lights;
  transport::SceneMatrix matrix;
  BareScene bare;
  BareReceivers bare_receivers;

  explicit Bench(const std::string& file)
      : scene(file, 800, 600),
        lights(scene.lights(100000, {}, false)),
        matrix(world, receivers, lights, {}),
        bare(world.rays()),
        bare_receivers(receivers) {
    std::size_t scattering_rows = 0, scattering_columns = 0;
    for (const std::uint32_t c : receivers.closure) scattering_rows += c != transport::Receivers::kLambertian;
    for (std::size_t j = 0; j < lights.size(); ++j)
      scattering_columns +=
          lights.kind[j] == LightKind::surface && lights.closure[j] != transport::VirtualLights::kLambertian;
    std::printf("%s: %zu triangles, %zu receivers (%.0f %% not lambertian), %zu lights (%.0f %%)\n",
                file.c_str(), world.info().triangles, receivers.size(),
                100.0 * static_cast<double>(scattering_rows) / static_cast<double>(receivers.size()),
                lights.size(),
                100.0 * static_cast<double>(scattering_columns) / static_cast<double>(lights.size()));
  }

  std::vector<matrix::ScaledColumn> pick_columns() const {
    Rng rng(1, Stage::benchmark);
    std::vector<matrix::ScaledColumn> columns(static_cast<std::size_t>(setting("BENCH_COLUMNS", 200)));
    for (auto& c : columns) c.column = static_cast<matrix::Index>(rng.next_below(lights.size()));
    return columns;
  }
};

void columns_against_bare(benchmark::State& state, const Bench& bench) {
  const auto columns = bench.pick_columns();
  std::vector<Rgb> sums(bench.receivers.size());
  std::vector<double> bare_rates, rates, ratios;
  for (auto _ : state) {
    const Timer bare_timer;
    const BareResult bare = trace_bare(bench.bare, bench.bare_receivers, bench.lights, columns);
    const double bare_seconds = bare_timer.seconds();
    const Timer timer;
    const std::uint64_t rays = bench.matrix.accumulate(columns, sums, {}).rays;
    const double seconds = timer.seconds();
    bare_rates.push_back(1e-6 * static_cast<double>(bare.rays) / bare_seconds);
    rates.push_back(1e-6 * static_cast<double>(rays) / seconds);
    ratios.push_back(rates.back() / bare_rates.back());
    state.SetIterationTime(seconds);
    state.counters["culled"] =
        1 - static_cast<double>(rays) / static_cast<double>(columns.size() * bench.receivers.size());
  }
  state.counters["bare Mrays/s"] = median(bare_rates);
  state.counters["accumulate Mrays/s"] = median(rates);
  state.counters["ratio"] = median(ratios);
}

void rows(benchmark::State& state, const Bench& bench) {
  Rng rng(2, Stage::benchmark);
  std::vector<Rgb> out(bench.lights.size());
  std::uint64_t traced = 0;
  double seconds = 0;
  for (auto _ : state) {
    const auto i = static_cast<matrix::Index>(rng.next_below(bench.receivers.size()));
    const Timer timer;
    traced += bench.matrix.row(i, out, matrix::Part::value).rays;
    seconds += timer.seconds();
    benchmark::DoNotOptimize(out.data());
  }
  state.counters["Mrays/s"] = 1e-6 * static_cast<double>(traced) / seconds;
}

}  // namespace

int main(int argc, char** argv) {
  benchmark::Initialize(&argc, argv);
  const std::string file = argc > 1 ? argv[1] : std::string(LUMIRANK_EXAMPLES) + "/interior.xml";
  lumirank::with_threads(setting("BENCH_THREADS", 0), [&] {
    const Bench bench(file);
    benchmark::RegisterBenchmark("columns",
                                 [&](benchmark::State& state) { columns_against_bare(state, bench); })
        ->UseManualTime()
        ->Iterations(7)
        ->Unit(benchmark::kMillisecond);
    benchmark::RegisterBenchmark("rows", [&](benchmark::State& state) { rows(state, bench); })
        ->Iterations(50)
        ->UseRealTime()
        ->Unit(benchmark::kMillisecond);
    benchmark::RunSpecifiedBenchmarks();
  });
}
