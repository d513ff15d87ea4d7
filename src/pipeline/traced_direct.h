// Direct light in sharp lobes by multiple importance sampling: point samples of a lamp seen in a narrow lobe
// are spots, so these lobes take their direct light from traced samples instead of the matrix's direct
// columns. The broad lobes of the same receivers stay in the matrix, free of noise.
#pragma once

#include <cstdint>
#include <vector>

#include "base/rgb.h"
#include "base/sinks.h"
#include "transport/rows/receivers.h"
#include "world/light_sampler.h"
#include "world/world.h"

namespace lumirank::pipeline {

struct TracedDirectSettings {
  std::uint64_t seed = 1;
  float below = 0.3f;  // lobes with a roughness below this are traced; > 1: all
  int samples = 16;    // light samples and as many BSDF samples per receiver
  int max_depth = -1;
  std::uint64_t pass = 0;  // as in transport::ReceiverSettings, where add() is called once
};

// Samples are added in passes; the bits depend on their number alone. World and receivers must outlive it.
class DirectTracing {
 public:
  DirectTracing(const world::World& world, const transport::Receivers& receivers,
                const TracedDirectSettings& settings);

  // More light samples and as many BSDF samples per receiver. False if it was cancelled: the sums are then of
  // no use.
  bool add(int samples, const Sinks& sinks = {});
  int samples() const { return samples_; }
  // pathtrace::Radiance towards the eye, one per receiver; zero where no lobe is traced.
  std::vector<Rgb> radiance() const;

 private:
  const world::World& world_;
  const transport::Receivers& receivers_;
  TracedDirectSettings settings_;
  const world::LightSampler& lights_;
  std::vector<Rgb> sums_;
  int samples_ = 0;
};

// All samples of the settings at once.
std::vector<Rgb> trace_direct(const world::World& world, const transport::Receivers& receivers,
                              const TracedDirectSettings& settings, const Sinks& sinks = {});

// Whether some lobe of a receiver is traced: the same question as the matrix asks
// (SceneMatrixSettings::traced_direct_below).
bool is_traced(const transport::Receivers& receivers, std::size_t i, float below);

}  // namespace lumirank::pipeline
