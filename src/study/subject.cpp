#include "study/subject.h"

#include <vector>

#include "pipeline/develop.h"
#include "pipeline/media_parts.h"
#include "pipeline/recipe.h"

namespace lumirank::study {
namespace {

class EmptySpace final : public Subject {
 public:
  EmptySpace(pipeline::SharedPrepared prepared, LightPart only)
      : prepared_(std::move(prepared)), only_(only) {}
  const matrix::LightingMatrix& matrix() const override { return *prepared_->matrix; }
  std::size_t lights() const override { return prepared_->lights().size(); }
  const std::map<std::string, double>& seconds() const override { return prepared_->seconds; }
  image::Image picture(std::span<const Rgb> sums) const override {
    const pipeline::Prepared& p = *prepared_;
    return pipeline::develop({*p.world, p.view, p.recipe, p.receivers(), p.traced}, sums,
                             pipeline::wanted_parts(only_));
  }
  SampledTruth::Film film() const override {
    const pipeline::Prepared& p = *prepared_;
    return {p.receivers().weight, p.receivers().sample, static_cast<std::size_t>(p.recipe.spp)};
  }

 private:
  pipeline::SharedPrepared prepared_;
  LightPart only_;
};

class InMedia final : public Subject {
 public:
  explicit InMedia(std::shared_ptr<const pipeline::PreparedMedia> prepared) : prepared_(std::move(prepared)) {
    const transport::Receivers& rows = prepared_->rows;
    weights_ = rows.weight, samples_ = rows.sample;
    weights_.insert(weights_.end(), rows.segments.weight.begin(), rows.segments.weight.end());
    samples_.insert(samples_.end(), rows.segments.sample.begin(), rows.segments.sample.end());
  }
  const matrix::LightingMatrix& matrix() const override { return *prepared_->matrix; }
  std::size_t lights() const override {
    return prepared_->lights.points.size() + prepared_->lights.rays.size();
  }
  const std::map<std::string, double>& seconds() const override { return prepared_->seconds; }
  image::Image picture(std::span<const Rgb> sums) const override {
    return pipeline::picture_of(*prepared_, sums);
  }
  SampledTruth::Film film() const override {
    return {weights_, samples_, static_cast<std::size_t>(prepared_->recipe.spp)};
  }

 private:
  std::shared_ptr<const pipeline::PreparedMedia> prepared_;
  std::vector<Rgb> weights_;
  std::vector<std::uint32_t> samples_;
};

}  // namespace

SharedSubject SubjectMaker::make(const SubjectWanted& wanted, const Sinks& sinks) {
  if (last_ && last_wanted_ == wanted) return last_;
  pipeline::Recipe recipe = make_recipe(settings_.base, view_);
  recipe.spp = wanted.spp;
  recipe.film_samples = 0;  // what is compared are sums of rows, all of them the film's
  recipe.light_seed = wanted.light_seed;
  if (in_media_) {
    last_.reset();
    last_ = std::make_shared<InMedia>(
        pipeline::prepare_in_media(world_, view_, recipe, {wanted.segments, wanted.lights, false}, sinks));
  } else {
    prepared_ = pipeline::prepare(world_, view_, recipe, wanted.lights, prepared_, sinks);
    last_ = std::make_shared<EmptySpace>(prepared_, settings_.base.view.only);
  }
  last_wanted_ = wanted;
  return last_;
}

}  // namespace lumirank::study
