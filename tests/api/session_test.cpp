// The library in steps: what is prepared, the matrix from outside, scenes in memory, relighting.
#include "lumirank/session.h"

#include <gtest/gtest.h>

#include <cmath>

#include "lumirank/scene_builder.h"

namespace lumirank {
namespace {

Mesh quad(Vec3f center, Vec3f u, Vec3f v) {
  Mesh mesh;
  mesh.positions = {center - u - v, center + u - v, center + u + v, center - u + v};
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  return mesh;
}

SceneBuilder floor_and_lamps() {
  SceneBuilder builder;
  const int gray = builder.add_material({.base_color = Rgb(0.5f)});
  builder.add_mesh(quad({0, 0, 0}, {1, 0, 0}, {0, 0, -1}), gray, Rgb(0.0f), "floor");
  builder.add_mesh(quad({0, 1, -1}, {1, 0, 0}, {0, 1, 0}), gray, Rgb(0.0f), "wall");
  builder.add_point_light({0.5f, 1, 0}, {3, 2, 1}, "warm");
  builder.add_point_light({-0.5f, 1, 0}, {1, 2, 3}, "cold");
  builder.set_camera({.origin = {0, 1, 4}, .target = {0, 0.5f, 0}, .width = 16, .height = 12});
  return builder;
}

RenderSettings small_matrix() {
  RenderSettings settings;
  settings.lights.count = 200;
  settings.view.spp = 1;
  settings.traced.direct = DirectLight::matrix;
  return settings;
}

template <typename Call>
std::string refusal(Call&& call) {
  try {
    call();
  } catch (const InputError& error) {
    return error.what();
  }
  return {};
}

TEST(PublicMatrix, AnEntryHasOneValueHoweverItIsAskedFor) {
  const Prepared prepared = prepare(floor_and_lamps().build(), small_matrix());
  const Matrix matrix = prepared.matrix();
  ASSERT_GT(matrix.rows(), 20u);
  ASSERT_GT(matrix.columns(), 100u);
  std::vector<Rgb> whole(matrix.rows() * matrix.columns());
  std::vector<Index> rows(matrix.rows()), columns(matrix.columns());
  for (std::size_t i = 0; i < rows.size(); ++i) rows[i] = static_cast<Index>(i);
  for (std::size_t j = 0; j < columns.size(); ++j) columns[j] = static_cast<Index>(j);
  const MatrixCost cost = matrix.block(rows, columns, whole);
  EXPECT_EQ(cost.entries, whole.size());
  EXPECT_GT(cost.shadow_rays, 0u);
  std::vector<Rgb> row(columns.size()), column(rows.size()), sums(rows.size()), single(1);
  std::vector<WeightedColumn> all(columns.size());
  for (std::size_t j = 0; j < all.size(); ++j) all[j].column = columns[j];
  matrix.accumulate(all, sums);
  for (std::size_t i = 0; i < rows.size(); i += 7) {
    matrix.row(rows[i], row);
    Rgb sum;
    for (std::size_t j = 0; j < columns.size(); ++j) {
      ASSERT_EQ(row[j], whole[i * columns.size() + j]);
      sum += row[j];
    }
    EXPECT_NEAR(sums[i].g, sum.g, 1e-4f * sum.g);
  }
  for (std::size_t j = 0; j < columns.size(); j += 11) {
    matrix.column(columns[j], column);
    for (std::size_t i = 0; i < rows.size(); ++i) ASSERT_EQ(column[i], whole[i * columns.size() + j]);
    matrix.entries({rows.data() + 3, 1}, {columns.data() + j, 1}, single);
    EXPECT_EQ(single[0], column[3]);
  }
}

TEST(PublicMatrix, RefusesWhatDoesNotFit) {
  const Matrix matrix = prepare(floor_and_lamps().build(), small_matrix()).matrix();
  std::vector<Rgb> row(matrix.columns()), column(matrix.rows());
  const auto beyond = static_cast<Index>(matrix.rows() + matrix.columns());
  EXPECT_NE(refusal([&] { matrix.row(0, column); }), "");
  EXPECT_NE(refusal([&] { matrix.column(0, row); }), "");
  EXPECT_NE(refusal([&] { matrix.row(beyond, row); }), "");
  EXPECT_NE(refusal([&] { matrix.accumulate(std::vector<WeightedColumn>{{beyond}}, column); }), "");
}

TEST(Session, APreparedRenderHasTheBitsOfARender) {
  const Scene scene = floor_and_lamps().build();
  RenderSettings settings = small_matrix();
  settings.traced.rest = RestOfPaths::skip;
  settings.method.name = "row-column-sampling";
  const Picture whole = render(scene, settings).picture;
  const Prepared prepared = prepare(scene, settings);
  const Picture in_steps = develop(prepared, estimate_sums(prepared, settings.method));
  EXPECT_EQ(whole.planes[0].rgb, in_steps.planes[0].rgb);
}

// With what was taken over, the picture is that of a preparation from nothing.
TEST(Session, WhatIsTakenOverChangesNoPicture) {
  const Scene scene = floor_and_lamps().build();
  const RenderSettings first = small_matrix();
  const Prepared previous = prepare(scene, first);
  std::vector<RenderSettings> others(6, first);
  others[1].lights.count = 300;
  others[2].view.spp = 2;
  others[3].lights.clamp = 0.5;
  others[4].layers = {"light:*"};
  others[5].seed = 7;
  for (std::size_t k = 0; k < others.size(); ++k) {
    const Prepared anew = prepare(scene, others[k]), after = prepare(scene, others[k], {}, previous);
    ASSERT_EQ(anew.matrix().rows(), after.matrix().rows()) << k;
    ASSERT_EQ(anew.matrix().columns(), after.matrix().columns()) << k;
    const MethodSettings method{.name = "power-sampling", .parameters = {{"columns", "50"}}};
    EXPECT_EQ(estimate_sums(anew, method).sums, estimate_sums(after, method).sums) << k;
  }
  // The settings of the matrix are the new ones too.
  EXPECT_NE(refusal([&] { Relighting(previous, estimate_sums(previous, {.name = "brute-force"})); }), "");
  const Prepared by_light = prepare(scene, others[4], {}, previous);
  EXPECT_EQ(Relighting(by_light, estimate_sums(by_light, {.name = "brute-force"})).lights().size(), 2u);
}

TEST(Session, RelightingIsLinear) {
  const Scene scene = floor_and_lamps().build();
  RenderSettings settings = small_matrix();
  settings.layers = {"light:*"};
  const Prepared prepared = prepare(scene, settings);
  const Relighting relighting(prepared, estimate_sums(prepared, {.name = "brute-force"}));
  const auto picture = [&](float warm, float cold) {
    return relighting.picture({{"warm", Rgb(warm)}, {"cold", Rgb(cold)}}).planes[0].rgb;
  };
  const auto warm = picture(1, 0), cold = picture(0, 1), mixed = picture(2, 0.5f);
  for (std::size_t k = 0; k < mixed.size(); ++k)
    EXPECT_NEAR(mixed[k], 2 * warm[k] + 0.5f * cold[k], 1e-5f * (1 + mixed[k]));
  EXPECT_NE(refusal([&] { relighting.picture({{"no such lamp", Rgb(1)}}); }).find("warm"), std::string::npos);
  EXPECT_NE(refusal([&] { Relighting(prepared, estimate_sums(prepared, {.name = "slice-cuts"})); }), "");
}

TEST(SceneBuilder, RefusesWhatIsWrongAndNamesIt) {
  SceneBuilder builder;
  EXPECT_NE(refusal([&] { builder.build(); }).find("camera"), std::string::npos);
  EXPECT_NE(refusal([&] {
              builder.add_material({.base_color = {2, 0, 0}});
            }).find("color"),
            std::string::npos);
  EXPECT_NE(refusal([&] { builder.add_material({.roughness = NAN}); }).find("roughness"), std::string::npos);
  EXPECT_NE(refusal([&] {
              builder.add_mesh(quad({}, {1, 0, 0}, {0, 1, 0}), 0);
            }).find("material"),
            std::string::npos);
  const int gray = builder.add_material({});
  Mesh broken = quad({}, {1, 0, 0}, {0, 1, 0});
  broken.triangles[0][1] = 9;
  EXPECT_NE(refusal([&] { builder.add_mesh(broken, gray, Rgb(0.0f), "door"); }).find("door"),
            std::string::npos);
  EXPECT_NE(refusal([&] { builder.add_point_light({NAN, 0, 0}, Rgb(1)); }), "");
  EXPECT_NE(refusal([&] { builder.add_directional_light({}, Rgb(1)); }), "");
  EXPECT_NE(refusal([&] { builder.set_camera({.origin = {0, 0, 0}, .target = {0, 0, 0}}); }), "");
  builder.set_environment(Rgb(1));
  EXPECT_NE(refusal([&] { builder.set_environment(Rgb(1)); }).find("environment"), std::string::npos);
}

}  // namespace
}  // namespace lumirank
