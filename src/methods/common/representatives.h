// From clusters to columns to render (2007, sections 3.3 and 4, "Representative selection and color
// averaging").
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "linalg/column_sketch.h"
#include "linalg/partition.h"
#include "matrix/lighting_matrix.h"
#include "methods/common/cluster_settings.h"

namespace lumirank::methods {

struct Representatives {
  std::vector<matrix::ScaledColumn> columns;  // in random order, so that every prefix is a fair sample
  std::vector<double> energy;                 // s of the cluster that the column represents; zero columns: 0
  std::size_t zero_columns = 0;               // of these, drawn from the columns that were zero on all rows
};

struct RepresentativeSettings {
  ColorMode color = ColorMode::averaged;
  std::uint64_t seed = 1;
  std::uint64_t round = 0;               // rounds are independent of each other
  float max_contribution = 0;            // see matrix::ScaledColumn
  std::span<const std::uint64_t> ids{};  // of the columns; may be unknown
};

// How likely a column is to represent its cluster: q_j = (1 − share)·‖ρ_j‖/Σ‖ρ‖ + share·power_j/Σ power, both
// sums over `lit`; 0 elsewhere. share = 0 is the paper's choice. Any other is as unbiased, and bounds the
// factor of a column that is all but zero on the sampled rows and not elsewhere, which would otherwise be
// drawn rarely and then scaled up without limit.
std::vector<float> selection_weights(std::span<const matrix::Index> lit, const linalg::ColumnSketch& sketch,
                                     std::span<const float> power, double share);

// One member of each cluster, with probability q_j/s, s = Σq over the cluster: the first to arrive where each
// does at the rate q_j, which hangs on who the members are and not on their order. scalar: scaled by s/q_j,
// unbiased. averaged: channel c is scaled by (s/q_j)·g_c with g_c = (Σ‖ρᶜ‖/‖ρᶜ_j‖) / (Σ‖ρ‖/‖ρ_j‖), the
// paper's Σ‖ρᶜ‖/‖ρᶜ_j‖ where q is ‖ρ‖. g_c is at most 4, and 1 where the representative has (next to) none of
// that channel.
Representatives choose_representatives(const linalg::Partition& clusters, const linalg::ColumnSketch& sketch,
                                       std::span<const float> weights,
                                       const RepresentativeSettings& settings);

// Adds `count` draws, by power, from the columns `zero`, which vanish on all rows that were read. That set is
// a function of the rows alone, so with every choice of rows the estimate of its sum is unbiased; ignoring
// the set is not.
void add_zero_columns(std::span<const matrix::Index> zero, std::span<const float> power, std::size_t count,
                      const RepresentativeSettings& settings, Representatives& representatives);

}  // namespace lumirank::methods
