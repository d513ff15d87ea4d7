// Everything that pictures are estimated on: a world, a view of it, the rows and columns of its matrix, and
// the matrix.
#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "base/sinks.h"
#include "pathtrace/path_tracer.h"
#include "pipeline/recipe.h"
#include "pipeline/traced_direct.h"
#include "transport/cpu/scene_matrix.h"
#include "transport/lights/virtual_lights.h"
#include "transport/rows/receivers.h"
#include "world/view.h"
#include "world/world.h"

namespace lumirank::pipeline {

using SharedWorld = std::shared_ptr<const world::World>;
using SharedRows = std::shared_ptr<const transport::Receivers>;
using SharedSurvey = std::shared_ptr<const transport::LightSurvey>;

struct Columns {
  std::shared_ptr<const transport::VirtualLights> lights;
  std::size_t asked = 0;                // how many there were to be
  double radius_scale = 0;              // of spherical lights; 0: points
  float max_reach = 0;                  // of points (give_reach)
  pathtrace::CarriedByColumns carried;  // where the rest is to be traced; bound 0: it is not
};

// Light towards the eye that is traced instead of going through the matrix, one value per receiver; empty
// where none is.
struct TracedLight {
  SharedRows rows;  // as the eye finds them, for the first two; nullptr: those of the matrix
  std::vector<Rgb> direct;
  int direct_samples = 0;  // per receiver
  std::vector<Rgb> sharp;  // indirect, in lobes that have left the rows
  std::vector<Rgb> near;   // indirect, from close by; at rows of the matrix
};
// The rows as the eye finds them, for given rows of the matrix.
const transport::Receivers& seen_rows(const transport::Receivers& rows, const TracedLight& traced);

// Owns what it is made of, never changes, and may be shared between threads and calls.
struct Prepared {
  SharedWorld world;
  View view;
  Recipe recipe;
  SharedRows rows;
  Columns columns;
  TracedLight traced;
  std::shared_ptr<const transport::SceneMatrix> matrix;
  std::map<std::string, double> seconds;  // by stage

  const transport::Receivers& receivers() const { return *rows; }
  const transport::VirtualLights& lights() const { return *columns.lights; }
};
using SharedPrepared = std::shared_ptr<const Prepared>;

// All stages one after the other, `count` virtual lights. What `previous` (may be empty) has made of the same
// world in the same way is taken over: its rows with their traced light, its columns, or both.
SharedPrepared prepare(const SharedWorld& world, const View& view, const Recipe& recipe, std::size_t count,
                       const SharedPrepared& previous, const Sinks& sinks);

// ------------------------------------------------------------------------ the stages, for who times them

// Rows as the eye finds them.
SharedRows trace_rows(const world::World& world, const View& view, const Recipe& recipe, const Sinks& sinks);
bool some_traced(const transport::Receivers& rows, float below);
// With receivers that stand for their sharp lobes, where the recipe says so.
SharedRows gather_rows(const world::World& world, SharedRows rows, const Recipe& recipe, const Sinks& sinks);
// Direct light of the lobes whose share is traced; nothing if there are none. Rows must outlive it.
std::unique_ptr<DirectTracing> start_direct(const world::World& world, const transport::Receivers& rows,
                                            const Recipe& recipe);
std::vector<Rgb> trace_sharp_lobes(const world::World& world, const transport::Receivers& rows,
                                   const Recipe& recipe, const Sinks& sinks);
// What is left of the rows for the matrix: without lobes that are traced wholly.
SharedRows matrix_rows(const SharedRows& rows, const Recipe& recipe);

// Rows of the matrix, and the light at them that is traced with the default number of samples. Adds to
// `seconds`.
struct TracedRows {
  SharedRows rows;
  TracedLight traced;
};
TracedRows trace_rows_and_light(const world::World& world, const View& view, const Recipe& recipe,
                                const Sinks& sinks, std::map<std::string, double>& seconds);

// What lights are aimed at: some 16,000 receivers spread over the whole film. Lights thus depend on the view,
// but neither on the crop nor on the number of pixels and samples.
transport::Receivers aim_at(const world::World& world, const View& view, std::uint64_t seed,
                            const Sinks& sinks);
SharedSurvey survey(const world::World& world, const Recipe& recipe, const transport::Receivers& aim);
// What the recipe's shot shares, or one for this view.
SharedSurvey survey(const SharedWorld& world, const View& view, const Recipe& recipe, const Sinks& sinks);
Columns trace_columns(const world::World& world, const Recipe& recipe, const transport::LightSurvey& survey,
                      std::size_t count, const Sinks& sinks);
std::vector<Rgb> trace_near(const world::World& world, const transport::Receivers& rows,
                            const Columns& columns, const Recipe& recipe, const Sinks& sinks);

// The matrix over what has been made. `seconds`: of the stages before.
SharedPrepared join(const SharedWorld& world, const View& view, const Recipe& recipe, SharedRows rows,
                    Columns columns, TracedLight traced, std::map<std::string, double> seconds);

}  // namespace lumirank::pipeline
