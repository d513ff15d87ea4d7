// Tensor clustering on made-up tensors: exact where it can be, better with more columns, and mappings.
#include "methods/tensor_clustering/tensor_clustering.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numeric>

#include "base/random.h"
#include "matrix/dense_matrix.h"
#include "matrix/synthetic.h"
#include "methods/common/column_pass.h"
#include "methods/tensor_clustering/cluster_reader.h"
#include "methods/tensor_clustering/row_mapping.h"

namespace lumirank::methods {
namespace {

using matrix::DenseMatrix;

class DenseTensor : public matrix::LightingTensor {
 public:
  explicit DenseTensor(std::vector<std::shared_ptr<const DenseMatrix>> frames) : frames_(std::move(frames)) {}
  std::size_t frames() const override { return frames_.size(); }
  std::size_t columns() const override { return frames_.front()->columns(); }
  std::shared_ptr<const matrix::LightingMatrix> frame(std::size_t k) const override { return frames_[k]; }
  std::vector<Rgb> exact(std::size_t k) const { return frames_[k]->exact_sums(); }

 private:
  std::vector<std::shared_ptr<const DenseMatrix>> frames_;
};

// `parts` of lights alike, whose directions turn a little from frame to frame, each light with a color and a
// brightness of its own that changes over time.
DenseTensor smooth_tensor(std::size_t rows, std::size_t columns, std::size_t frames, std::size_t parts,
                          double change) {
  std::vector<std::shared_ptr<const DenseMatrix>> made;
  for (std::size_t k = 0; k < frames; ++k) {
    std::vector<Rgb> entries(rows * columns);
    for (std::size_t j = 0; j < columns; ++j) {
      const double phase = 2.399 * static_cast<double>(j % parts) + change * static_cast<double>(k);
      const auto bright = static_cast<float>(1 + static_cast<double>(j % 5) + 0.1 * static_cast<double>(k));
      const Rgb color{1, 0.2f + 0.1f * static_cast<float>(j % parts), 0.5f};
      for (std::size_t i = 0; i < rows; ++i)
        entries[i * columns + j] =
            color * (bright * static_cast<float>(1.2 + std::sin(phase + 0.1 * static_cast<double>(i))));
    }
    made.push_back(std::make_shared<const DenseMatrix>(rows, columns, std::move(entries)));
  }
  return DenseTensor(std::move(made));
}

double worst_error(const DenseTensor& tensor, const TensorEstimate& estimate) {
  double worst = 0;
  for (std::size_t k = 0; k < tensor.frames(); ++k)
    worst = std::max(worst, relative_difference(estimate.sums[k], tensor.exact(k)));
  return worst;
}

TensorClusteringSettings settings_of(std::size_t columns) {
  TensorClusteringSettings settings;
  settings.columns = columns, settings.rows = 40, settings.initial_clusters = 10;
  settings.carrying = Carrying::always;
  return settings;
}

// Lights that differ in brightness alone are one cluster, in time as well.
TEST(TensorClustering, IsExactForAsManyClustersAsDirections) {
  const DenseTensor tensor = smooth_tensor(90, 60, 8, 6, 0);
  const TensorEstimate e = estimate_tensor(tensor, settings_of(2), {});
  EXPECT_LE(e.clusters, 16u);
  EXPECT_LT(worst_error(tensor, e), 2e-5);  // sixteen bits of directions
  for (const std::size_t active : e.active) EXPECT_GE(active, 6u);
  EXPECT_LE(e.spent.entries,
            16u * 90 + 40u * 60 * 8 + 8u * 12 * 16);  // and a row in eight is asked for changes
}

TEST(TensorClustering, ErrorFallsToNothing) {
  const DenseTensor tensor = smooth_tensor(90, 60, 10, 15, 0.15);
  double before = 1;
  for (const std::size_t columns : {1u, 3u, 10u, 60u}) {
    TensorClusteringSettings settings = settings_of(columns);
    settings.max_change = 0, settings.filter = 0;
    const double error = worst_error(tensor, estimate_tensor(tensor, settings, {}));
    EXPECT_LT(error, before) << columns;
    before = error;
  }
  EXPECT_LT(before, 1e-6);  // every light in every frame
}

TEST(TensorClustering, AStaticSceneIsTheSameInAllFrames) {
  const DenseTensor tensor = [] {
    const auto one = std::make_shared<const DenseMatrix>(matrix::low_rank_matrix({100, 80, 3}, 8));
    return DenseTensor({one, one, one, one, one});
  }();
  const TensorEstimate e = estimate_tensor(tensor, settings_of(6), {});
  for (std::size_t k = 1; k < 5; ++k) EXPECT_EQ(e.sums[k], e.sums[0]) << k;
  EXPECT_EQ(e.active[0], e.clusters);  // no cluster is cut in time
  EXPECT_LT(worst_error(tensor, e), 0.3);
}

// Frames that have nothing in common, between which nothing is worth carrying, and frames that are all the
// same, where a column serves all of them.
TEST(TensorClustering, CarriesLightWhereClustersLast) {
  constexpr std::size_t kRows = 100, kLights = 80, kFrames = 6, kRank = 5;
  const auto tensor_of = [&](bool still) {
    std::vector<std::shared_ptr<const DenseMatrix>> frames;
    for (std::size_t k = 0; k < kFrames; ++k)
      frames.push_back(std::make_shared<const DenseMatrix>(
          matrix::low_rank_matrix({kRows, kLights, kRank}, still ? 0 : k)));
    return DenseTensor(std::move(frames));
  };
  TensorClusteringSettings settings = settings_of(10);
  settings.carrying = Carrying::automatic;
  EXPECT_TRUE(estimate_tensor(tensor_of(true), settings, {}).carried);
  const DenseTensor tensor = tensor_of(false);
  double before = 1;
  for (const std::size_t columns : {10u, 30u, 80u}) {
    settings.columns = columns;
    const TensorEstimate estimate = estimate_tensor(tensor, settings, {});
    EXPECT_FALSE(estimate.carried) << columns;
    const double error = worst_error(tensor, estimate);
    EXPECT_LT(error, before) << columns;
    // Of every frame a part of the rows whole, and all rows of the clusters that act in it (but for those
    // that are black there).
    const double acting = std::accumulate(estimate.active.begin(), estimate.active.end(), 0.0);
    const double computed = static_cast<double>(estimate.spent.entries) - kFrames * 40.0 * kLights;
    EXPECT_LE(computed, acting * kRows);
    EXPECT_GT(computed, 0.7 * acting * kRows);
    before = error;
  }
  EXPECT_LT(before, 1e-6);  // every light in every frame
}

// Where nothing is carried a frame costs the clusters that act in it: they are counted.
TEST(TensorClustering, ShadesAsManyClustersAsWereAskedFor) {
  constexpr std::size_t kFrames = 6, kColumns = 24;
  const DenseTensor tensor = smooth_tensor(90, 60, kFrames, 15, 0.15);
  TensorClusteringSettings settings = settings_of(kColumns);
  settings.carrying = Carrying::never;
  const TensorEstimate estimate = estimate_tensor(tensor, settings, {});
  const double acting = std::accumulate(estimate.active.begin(), estimate.active.end(), 0.0);
  EXPECT_LE(acting, kColumns * kFrames);
  EXPECT_GT(acting, (kColumns - 1) * kFrames);
  EXPECT_FALSE(estimate.carried);
}

// Rows of one place on the film, as pieces of one eye ray are: only the first is always read, unless two are
// asked for.
TEST(TensorClustering, ReadsTwoRowsOfAPlace) {
  constexpr std::size_t kPlaces = 16, kRowsOfPlace = 4, kLights = 30;
  std::vector<Rgb> entries(kPlaces * kRowsOfPlace * kLights, Rgb(0));
  // What is told by other rows than the first: 6 sorts of light.
  for (std::size_t i = 0; i < kPlaces * kRowsOfPlace; ++i)
    for (std::size_t j = 0; j < kLights; ++j)
      entries[i * kLights + j] = Rgb(i < kPlaces ? 1.0f : (i + j) % 6 == 0 ? 3.0f : 0.5f);
  const auto frame = std::make_shared<DenseMatrix>(kPlaces * kRowsOfPlace, kLights, std::move(entries));
  for (std::size_t i = 0; i < kPlaces * kRowsOfPlace; ++i)
    frame->pixel.push_back({static_cast<float>(i % kPlaces % 4), static_cast<float>(i % kPlaces / 4)});
  const DenseTensor tensor({frame});
  TensorClusteringSettings settings = settings_of(15);
  settings.rows = kPlaces, settings.carrying = Carrying::never;
  EXPECT_GT(worst_error(tensor, estimate_tensor(tensor, settings, {})), 0.1);
  settings.two_of_a_place = true;
  EXPECT_LT(worst_error(tensor, estimate_tensor(tensor, settings, {})), 1e-6);
}

TEST(TensorClustering, SixteenAndThirtyTwoBitsAgree) {
  const DenseTensor tensor = smooth_tensor(90, 60, 10, 15, 0.15);
  TensorClusteringSettings settings = settings_of(20);
  const double short_error = worst_error(tensor, estimate_tensor(tensor, settings, {}));
  settings.precision = linalg::ReducedTensor::Precision::bits32;
  EXPECT_NEAR(worst_error(tensor, estimate_tensor(tensor, settings, {})), short_error, 0.2 * short_error);
}

// A plane of points that moves by one pixel in each frame: what is seen by row i of the next frame was seen
// by row i + 1, and composed over frames by row i + steps, until the edge.
TEST(RowMapping, FollowsAPlaneThatMovesRigidly) {
  const std::size_t rows = 50;
  const auto plane = [&](int frame) {
    DenseMatrix m(rows, 1, std::vector<Rgb>(rows, Rgb(1)));
    for (std::size_t i = 0; i < rows; ++i) {
      m.row_position.push_back({static_cast<float>(static_cast<int>(i) + frame), 0, 0});
      m.row_normal.push_back({0, 0, 1});
    }
    return m;
  };
  RowMapping all = RowMapping::identity(rows);
  for (int frame = 1; frame <= 5; ++frame) all = all.then(nearest_rows(plane(frame), plane(frame - 1), 50));
  for (std::size_t i = 0; i < rows; ++i) {
    EXPECT_EQ(all.from[i], std::min(i + 5, rows - 1));
    if (i + 5 < rows)
      EXPECT_EQ(all.distance[i], 0);
    else
      EXPECT_GT(all.distance[i], 0);
  }
}

// A wall of which a board hides a part, that moves away in the second frame: the rows behind it are far from
// all that the first frame shows of the wall, so they are shaded afresh and exact, and get nothing of the
// board's.
TEST(TensorClustering, WhatWasHiddenIsShadedAfresh) {
  const std::size_t rows = 40, hidden_from = 12, hidden_to = 28;
  const auto frame = [&](bool board) {
    std::vector<Rgb> entries(2 * rows);
    std::vector<Vec3f> places(rows), normals(rows, Vec3f{0, 0, 1});
    for (std::size_t i = 0; i < rows; ++i) {
      const bool on_board = board && i >= hidden_from && i < hidden_to;
      places[i] = {static_cast<float>(i), 0, on_board ? 5.0f : 0.0f};
      for (std::size_t j = 0; j < 2; ++j) entries[2 * i + j] = Rgb(on_board ? 5.0f : 1.0f);
    }
    auto m = std::make_shared<DenseMatrix>(rows, 2, std::move(entries));
    m->row_position = places, m->row_normal = normals;
    return m;
  };
  const DenseTensor tensor({frame(true), frame(false)});
  TensorClusteringSettings settings = settings_of(1);
  settings.max_distance = 4, settings.max_change = 0;
  settings.initial_clusters = 1, settings.rows = 2;  // rows 10 and 30: none of them sees the board
  const TensorEstimate fresh = estimate_tensor(tensor, settings, {});
  settings.max_distance = 0;
  const TensorEstimate carried = estimate_tensor(tensor, settings, {});
  double worst = 0, worst_carried = 0;
  for (std::size_t i = hidden_from + 6; i < hidden_to - 6; ++i) {
    worst = std::max(worst, std::abs(1 - static_cast<double>(fresh.sums[1][i].g / tensor.exact(1)[i].g)));
    worst_carried = std::max(worst_carried,
                             std::abs(1 - static_cast<double>(carried.sums[1][i].g / tensor.exact(1)[i].g)));
  }
  EXPECT_LT(worst, 1e-5);
  EXPECT_GT(fresh.trace.numbers.at("rows.afresh"), 0);
  EXPECT_EQ(carried.trace.numbers.at("rows.afresh"), 0);
  EXPECT_GT(worst_carried, 3);  // without the bound the board leaves a ghost
}

// A floor that stays, and on it a shadow that moves: rows of the reduced tensor stand between its places, so
// no clustering knows of it. It neither stays behind nor comes late.
TEST(TensorClustering, AShadowThatMovesDoesNotGhost) {
  const int size = 40, frames = 5;
  const auto dark = [&](int x, int y, int frame) { return std::hypot(x - 8 - 5 * frame, y - 18) < 6.5; };
  std::vector<std::shared_ptr<const DenseMatrix>> made;
  for (int k = 0; k < frames; ++k) {
    std::vector<Rgb> entries;
    auto places = std::vector<Vec3f>(), normals = std::vector<Vec3f>();
    auto pixels = std::vector<Vec2f>();
    for (int y = 0; y < size; ++y)
      for (int x = 0; x < size; ++x) {
        entries.push_back(Rgb(dark(x, y, k) ? 0.0f : 1.0f));
        entries.push_back(Rgb(0.2f));
        places.push_back({static_cast<float>(x), static_cast<float>(y), 0});
        normals.push_back({0, 0, 1});
        pixels.push_back({static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f});
      }
    auto m = std::make_shared<DenseMatrix>(places.size(), 2, std::move(entries));
    m->row_position = places, m->row_normal = normals, m->pixel = pixels;
    made.push_back(m);
  }
  const DenseTensor tensor(std::move(made));
  TensorClusteringSettings settings = settings_of(1);
  settings.rows = 4, settings.time_weight = 0;
  const TensorEstimate followed = estimate_tensor(tensor, settings, {});
  settings.max_change = 0;
  const TensorEstimate carried = estimate_tensor(tensor, settings, {});
  EXPECT_LT(worst_error(tensor, followed), 1e-4);
  EXPECT_GT(worst_error(tensor, carried), 0.1);
  EXPECT_GT(followed.trace.numbers.at("rows.changed"), 0);
  EXPECT_LT(followed.trace.numbers.at("rows.changed"), 0.5);
}

// Lights of one kind, each of which is a bright spot at a row of its own that no clustering reads. The one
// that stands for them would make its spot as bright as all of them together.
TEST(TensorClustering, AClusterIsSummedWhereItsRepresentativeStandsTooClose) {
  constexpr std::size_t kRows = 640, kLights = 20, kFrames = 2;
  constexpr float kSpot = 60;
  const auto spot_of = [](std::size_t j) { return 32 * j + 9; };
  std::vector<std::shared_ptr<const DenseMatrix>> made;
  for (std::size_t k = 0; k < kFrames; ++k) {
    std::vector<Rgb> entries(kRows * kLights, Rgb(1, 0.5f, 0));
    for (std::size_t j = 0; j < kLights; ++j) {
      entries[spot_of(j) * kLights + j] = Rgb(kSpot);
      entries[(spot_of(j) + 1) * kLights + j] = Rgb(8);  // no peak by itself, but next to one
    }
    made.push_back(std::make_shared<const DenseMatrix>(kRows, kLights, std::move(entries)));
  }
  const DenseTensor tensor(std::move(made));
  TensorClusteringSettings settings = settings_of(1);
  settings.initial_clusters = 1;
  const auto brightest = [&](double max_peak) {
    settings.max_peak = max_peak;
    const TensorEstimate e = estimate_tensor(tensor, settings, {});
    EXPECT_EQ(e.clusters, 1u);
    EXPECT_EQ(e.sums[0], e.sums[1]);
    return static_cast<std::size_t>(std::max_element(e.sums[0].begin(), e.sums[0].end(),
                                                     [](const Rgb& a, const Rgb& b) { return a.r < b.r; }) -
                                    e.sums[0].begin());
  };
  const std::size_t spot = brightest(0);
  const TensorEstimate as_it_is = estimate_tensor(tensor, settings, {});
  ASSERT_EQ(spot % 32, 9u);
  EXPECT_NEAR(as_it_is.sums[0][spot].r, kSpot * kLights, 1);
  EXPECT_EQ(brightest(0.05), spot);
  const TensorEstimate summed = estimate_tensor(tensor, settings, {});
  for (const std::size_t row : {spot, spot + 1})
    EXPECT_NEAR(summed.sums[0][row].r, tensor.exact(0)[row].r, 1e-3f) << row;
  EXPECT_EQ(summed.sums[0][spot + 2], as_it_is.sums[0][spot + 2]);
}

// What a cluster is at a row is the same whichever rows are asked for beside it.
TEST(ClusterReader, DoesNotDependOnTheOtherRows) {
  constexpr std::size_t kRows = 200, kLights = 6;
  std::vector<Rgb> entries(kRows * kLights);
  Rng rng(7, Stage::method);
  for (Rgb& e : entries) e = Rgb(std::pow(rng.next_float(), 8.0f));
  const DenseMatrix matrix(kRows, kLights, std::move(entries));
  const std::vector<std::uint32_t> lights{0, 1, 2, 3, 4, 5};
  const ClusterLight cluster{3, Rgb(5), Rgb(5), lights, 3.5f};
  const auto read = [&](const std::vector<matrix::Index>& rows) {
    const auto reader = matrix.reader();
    reader->set_rows(rows);
    std::vector<Rgb> column(rows.size());
    ClusterReader(*reader, rows, kRows).read(cluster, column);
    return column;
  };
  std::vector<matrix::Index> all(kRows);
  std::iota(all.begin(), all.end(), matrix::Index{0});
  const std::vector<Rgb> whole = read(all), exact = matrix.exact_sums();
  std::vector<Rgb> plain(kRows);
  matrix.column(3, plain);
  std::size_t summed = 0;
  for (const matrix::Index i : all) {
    EXPECT_EQ(read({i})[0], whole[i]) << i;
    if (whole[i] == plain[i]) continue;
    ++summed;
    EXPECT_NEAR(whole[i].g * 5, exact[i].g, 1e-5f);
  }
  EXPECT_GT(summed, 5u);
  EXPECT_LT(summed, kRows / 2);
  EXPECT_EQ(read({150, 7, 151, 8}), (std::vector<Rgb>{whole[150], whole[7], whole[151], whole[8]}));
}

// A plane with a texture, seen a third of a pixel farther in every frame: light is divided by the reflectance
// of the row that it comes from, so it is exact.
TEST(TensorClustering, CarriesLightOverATextureExactly) {
  const std::size_t rows = 60, frames = 4;
  std::vector<std::shared_ptr<const DenseMatrix>> made;
  for (std::size_t k = 0; k < frames; ++k) {
    std::vector<Rgb> entries;
    auto m = std::make_shared<DenseMatrix>(rows, 1, std::vector<Rgb>(rows, Rgb(0)));
    for (std::size_t i = 0; i < rows; ++i) {
      const float x = static_cast<float>(i) + static_cast<float>(k) / 3;
      const Rgb color{0.5f + 0.4f * std::sin(x), 0.3f, 0.4f + 0.3f * std::cos(2 * x)};
      entries.push_back(color * 2);
      m->row_albedo.push_back(color);
      m->row_position.push_back({x, 0, 0});
      m->row_normal.push_back({0, 0, 1});
    }
    auto whole = std::make_shared<DenseMatrix>(rows, 1, std::move(entries));
    whole->row_albedo = m->row_albedo, whole->row_position = m->row_position,
    whole->row_normal = m->row_normal;
    made.push_back(whole);
  }
  const DenseTensor tensor(std::move(made));
  TensorClusteringSettings settings = settings_of(1);
  settings.rows = rows, settings.time_weight = 0, settings.initial_clusters = 1;
  settings.max_change = settings.max_distance = 0;
  const TensorEstimate e = estimate_tensor(tensor, settings, {});
  EXPECT_EQ(e.clusters, 1u);
  for (std::size_t k = 0; k < frames; ++k)
    for (std::size_t i = 0; i < rows; ++i) {
      // Up to one scale for each frame and channel: that of the norms.
      for (int c = 0; c < 3; ++c)
        EXPECT_NEAR(e.sums[k][i][c] / e.sums[k][0][c], tensor.exact(k)[i][c] / tensor.exact(k)[0][c], 1e-4f)
            << k << " " << i;
    }
}

TEST(Relight, IsBoundedAndKeepsLightOfBlackSurfaces) {
  EXPECT_EQ(relight({1, 2, 3}, {0.5f, 0.5f, 0.5f}, {0.25f, 0.5f, 1}), Rgb(0.5f, 2, 6));
  EXPECT_EQ(relight(Rgb(1), Rgb(0), Rgb(1)), Rgb(1));
  EXPECT_EQ(relight(Rgb(1), Rgb(0.01f), Rgb(1)), Rgb(8));
}

// As many columns as the error needs, and the test rows tell it.
TEST(TensorClustering, FindsTheColumnsForAnError) {
  const DenseTensor tensor = smooth_tensor(120, 400, 10, 40, 0.1);
  std::size_t before = 0;
  for (const double error : {0.1, 0.01, 0.001}) {
    TensorClusteringSettings settings = settings_of(1);
    settings.target_error = error, settings.max_change = 0;
    const TensorEstimate e = estimate_tensor(tensor, settings, {});
    EXPECT_LE(e.predicted_error, error);
    EXPECT_GE(e.predicted_error, 0);
    EXPECT_LT(worst_error(tensor, e), 2 * error);
    EXPECT_GE(e.clusters, before);
    before = e.clusters;
  }
  EXPECT_LT(before, 400u * 10);
}

// The nearest is found whatever the first guess: against all pairs.
TEST(RowMapping, FindsTheNearestOfAll) {
  const std::size_t rows = 300;
  const auto cloud = [&](std::uint64_t seed) {
    Rng rng(seed, Stage::test);
    const auto number = [&] { return static_cast<float>(rng.next_double()); };
    DenseMatrix m(rows, 1, std::vector<Rgb>(rows, Rgb(1)));
    for (std::size_t i = 0; i < rows; ++i) {
      m.row_position.push_back({number(), number(), number()});
      m.row_normal.push_back({number(), number(), number()});
      m.row_albedo.push_back({number(), number(), number()});
    }
    return m;
  };
  const DenseMatrix a = cloud(1), b = cloud(2);
  const RowMapping m = nearest_rows(b, a, 2);
  for (std::size_t i = 0; i < rows; ++i) {
    const auto squared = [&](std::size_t k) {
      const float n = 2.0f / 8, r = 2.0f / 64;
      float sum = length_squared(b.row_position[i] - a.row_position[k]) +
                  n * n * length_squared(b.row_normal[i] - a.row_normal[k]);
      for (int c = 0; c < 3; ++c)
        sum += r * r * (b.row_albedo[i][c] - a.row_albedo[k][c]) * (b.row_albedo[i][c] - a.row_albedo[k][c]);
      return sum;
    };
    for (std::size_t k = 0; k < rows; ++k) EXPECT_GE(squared(k), squared(m.from[i]) * 0.9999f);
  }
}

// A frame in which the camera sees nothing, between others: what comes after it is shaded afresh.
TEST(TensorClustering, AFrameMayShowNothing) {
  const auto seen = std::make_shared<const DenseMatrix>(matrix::low_rank_matrix({30, 20, 2}, 8));
  const auto nothing = std::make_shared<const DenseMatrix>(0, 20, std::vector<Rgb>());
  const DenseTensor tensor({seen, nothing, seen});
  const TensorEstimate e = estimate_tensor(tensor, settings_of(20), {});
  EXPECT_TRUE(e.sums[1].empty());
  EXPECT_LT(relative_difference(e.sums[0], tensor.exact(0)), 1e-4);
  EXPECT_LT(relative_difference(e.sums[2], tensor.exact(2)), 1e-4);
}

// Two surfaces at one place are told apart by their normals and colors.
TEST(RowMapping, ReachesAsLargeAPartOfLargePictures) {
  const float infinity = std::numeric_limits<float>::infinity();
  for (const std::size_t rows : {10ul, 65'536ul}) {
    EXPECT_TRUE(reaches(10, 10, rows));
    EXPECT_FALSE(reaches(10.1f, 10, rows));
  }
  // Twice as wide and high: there are twice as many samples between the same places.
  EXPECT_TRUE(reaches(20, 10, 4 * 65'536));
  EXPECT_FALSE(reaches(20.2f, 10, 4 * 65'536));
  EXPECT_TRUE(reaches(1e9f, 0, 10));
  EXPECT_FALSE(reaches(infinity, 0, 10));
}

TEST(RowMapping, TellsSurfacesApart) {
  DenseMatrix a(4, 1, std::vector<Rgb>(4, Rgb(1)));
  a.row_position = {{0, 0, 0}, {0, 0, 0}, {0.1f, 0, 0}, {0.1f, 0, 0}};
  a.row_normal = {{0, 0, 1}, {1, 0, 0}, {0, 0, 1}, {0, 0, 1}};
  a.row_albedo = {Rgb(0.5f), Rgb(0.5f), {1, 0, 0}, {0, 0, 1}};
  DenseMatrix b(4, 1, std::vector<Rgb>(4, Rgb(1)));
  for (const std::size_t i : {3u, 1u, 0u, 2u}) {
    b.row_position.push_back(a.row_position[i]);
    b.row_normal.push_back(a.row_normal[i]);
    b.row_albedo.push_back(a.row_albedo[i]);
  }
  EXPECT_EQ(nearest_rows(b, a, 2).from, (std::vector<matrix::Index>{3, 1, 0, 2}));
}

}  // namespace
}  // namespace lumirank::methods
