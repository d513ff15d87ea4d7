// What the runs of a comparison sample: the matrix of a scene, in empty space or with participating media,
// and the picture that sums of its rows give.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <span>
#include <string>

#include "image/image.h"
#include "lumirank/compare.h"
#include "pipeline/prepared.h"
#include "study/sampled_truth.h"

namespace lumirank::study {

class Subject {
 public:
  virtual ~Subject() = default;
  virtual const matrix::LightingMatrix& matrix() const = 0;
  virtual std::size_t lights() const = 0;                            // points, and in media rays
  virtual const std::map<std::string, double>& seconds() const = 0;  // of making it, by stage
  virtual image::Image picture(std::span<const Rgb> sums) const = 0;
  virtual SampledTruth::Film film() const = 0;
};
using SharedSubject = std::shared_ptr<const Subject>;

// In media methods differ in what rays are to be for them.
struct SubjectWanted {
  std::size_t lights = 0;
  int spp = 0;
  std::uint64_t light_seed = 1;
  matrix::MethodContract::Segments segments = matrix::MethodContract::Segments::pieces;
  bool operator==(const SubjectWanted&) const = default;
};

class SubjectMaker {
 public:
  // Holds references.
  SubjectMaker(const CompareSettings& settings, pipeline::SharedWorld world, const pipeline::View& view,
               bool in_media)
      : settings_(settings), world_(std::move(world)), view_(view), in_media_(in_media) {}

  // The one before is kept while the next is wanted alike.
  SharedSubject make(const SubjectWanted& wanted, const Sinks& sinks);

 private:
  const CompareSettings& settings_;
  pipeline::SharedWorld world_;
  const pipeline::View& view_;
  bool in_media_;
  SubjectWanted last_wanted_;
  SharedSubject last_;
  pipeline::SharedPrepared prepared_;  // in empty space: stages are taken over one by one
};

}  // namespace lumirank::study
