// Reference that the runs of a comparison are measured against: made or read once, before the first of them.
#pragma once

#include <memory>
#include <span>

#include "image/image.h"
#include "lumirank/compare.h"
#include "study/subject.h"

namespace lumirank::study {

class StudyReference {
 public:
  // Reads it, if it is a file. Throws InputError for one that does not fit the view, or more receivers than
  // there are.
  StudyReference(const CompareSettings& settings, const pipeline::View& view);

  // Whether it is made of the columns that the runs then sample.
  bool is_of_columns() const;
  bool is_file() const { return wanted_.kind == ComparisonReference::Kind::file; }
  // A picture of all pixels; otherwise errors are known at some receivers only.
  bool is_picture() const { return wanted_.kind != ComparisonReference::Kind::receivers; }

  // Makes what is not a file; fills the reference's part of `results`. `subject`: may be nullptr unless
  // is_of_columns(). Throws Cancelled.
  void make(const world::World& world, const Subject* subject, const Sinks& sinks, Comparison& results);
  const image::Image& picture() const { return picture_; }
  const SampledTruth* sampled() const { return sampled_.get(); }

 private:
  void read_file();
  void trace(const world::World& world, const Sinks& sinks, Comparison& results);
  void sum_columns(const Subject& subject, const Sinks& sinks, Comparison& results);
  void sum_at_receivers(const Subject& subject, const Sinks& sinks, Comparison& results);

  const CompareSettings& settings_;
  const ComparisonReference& wanted_;
  const pipeline::View& view_;
  image::Image picture_;
  std::unique_ptr<SampledTruth> sampled_;
};

}  // namespace lumirank::study
