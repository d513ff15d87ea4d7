// Motion blur: the instants of an open shutter, and what is prepared for all of them (Walter et al. 2006):
// rows and columns belong to one instant each, in one matrix whose entries of different instants are 0.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "lumirank/settings.h"
#include "methods/method.h"
#include "pathtrace/reference.h"
#include "pipeline/prepared.h"
#include "transport/cpu/instants_matrix.h"

namespace lumirank::pipeline {

using pathtrace::Instant;

// So many moments from `open` to `close` (any unit), one in each of as many equal parts, at a random place of
// its own there: means over them are unbiased.
std::vector<double> instants_between(double open, double close, std::size_t count, std::uint64_t seed);

// Throws InputError for what a picture of one moment can be asked for and one of several cannot: methods that
// know one moment alone, time budgets, layers, compensation.
void check_exposure(const methods::MethodInfo& method, const RenderSettings& settings);

struct Exposure {
  std::vector<SharedPrepared> instants;
  std::shared_ptr<const transport::InstantsMatrix> matrix;

  // One value per film sample of all instants, one after the other, and where these are on the film.
  std::vector<Rgb> values(std::span<const Rgb> sums, LightPart only) const;
  std::vector<Vec2f> film() const;
};

// `count` virtual lights over all instants, as many for each. Every pixel's samples are spread over the
// instants. Lights are aimed at what the middle instant shows. Worlds must have the same units.
Exposure prepare_exposure(const std::vector<Instant>& instants, const Recipe& recipe, std::size_t count,
                          const Sinks& sinks);

}  // namespace lumirank::pipeline
