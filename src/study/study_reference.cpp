#include "study/study_reference.h"

#include <filesystem>

#include "base/error.h"
#include "base/timer.h"
#include "image/image_io.h"
#include "pathtrace/reference.h"
#include "pipeline/recipe.h"

namespace lumirank::study {
namespace {

using Kind = ComparisonReference::Kind;

constexpr std::size_t kMinReceivers = 64;

}  // namespace

StudyReference::StudyReference(const CompareSettings& settings, const pipeline::View& view)
    : settings_(settings), wanted_(settings.reference), view_(view) {
  if (wanted_.kind == Kind::file) read_file();
  if (wanted_.kind != Kind::receivers) return;
  if (wanted_.receivers < kMinReceivers)
    throw InputError("'brute-force:" + std::to_string(wanted_.receivers) + "' is not a reference",
                     "write brute-force:N with N at least 64");
  const auto available = static_cast<std::size_t>(view_.width) * static_cast<std::size_t>(view_.height) *
                         static_cast<std::size_t>(settings_.base.view.spp_or_default());
  if (wanted_.receivers > available)
    throw InputError("'brute-force:" + std::to_string(wanted_.receivers) +
                         "' asks for more receivers than the " + std::to_string(available) +
                         " film samples of this render",
                     "write brute-force for all of them, or a smaller number");
}

bool StudyReference::is_of_columns() const {
  return wanted_.kind == Kind::brute_force || wanted_.kind == Kind::receivers;
}

void StudyReference::read_file() {
  picture_ = image::read_image(wanted_.file).color;
  if (picture_.width != view_.width || picture_.height != view_.height)
    throw InputError({wanted_.file, 0},
                     "the reference has " + std::to_string(picture_.width) + "x" +
                         std::to_string(picture_.height) + " pixels, the render " +
                         std::to_string(view_.width) + "x" + std::to_string(view_.height),
                     "give --size or another reference");
}

void StudyReference::make(const world::World& world, const Subject* subject, const Sinks& sinks,
                          Comparison& results) {
  const Timer timer;
  switch (wanted_.kind) {
    case Kind::path:
      trace(world, sinks, results);
      break;
    case Kind::brute_force:
      sum_columns(*subject, sinks, results);
      break;
    case Kind::receivers:
      sum_at_receivers(*subject, sinks, results);
      break;
    case Kind::file:
      results.reference_kind = std::filesystem::path(wanted_.file).filename().string();
      break;
  }
  results.reference_seconds = timer.seconds();
}

void StudyReference::trace(const world::World& world, const Sinks& sinks, Comparison& results) {
  // In media what columns carry is not told from what they do not.
  const bool media = !world.media().empty();
  const auto traced = pathtrace::path_trace(
      world, view_,
      pipeline::reference_options(settings_.base.view.only, settings_.base.seed,
                                  media ? ReferencePaths::all : ReferencePaths::columns),
      {.time = wanted_.seconds}, sinks);
  if (traced.interrupted) throw Cancelled();
  picture_ = traced.image;
  results.reference_error = traced.error;
  results.reference_kind = "path tracing, " + std::to_string(traced.spp) + " paths per pixel" +
                           (media ? "" : ", paths that columns carry");
}

void StudyReference::sum_columns(const Subject& subject, const Sinks& sinks, Comparison& results) {
  std::vector<matrix::ScaledColumn> columns(subject.matrix().columns());
  for (std::size_t j = 0; j < columns.size(); ++j) columns[j].column = static_cast<matrix::Index>(j);
  std::vector<Rgb> sums(subject.matrix().rows());
  subject.matrix().accumulate(columns, sums, sinks);
  if (sinks.cancelled()) throw Cancelled();
  picture_ = subject.picture(sums);
  results.reference_kind = "all " + std::to_string(columns.size()) + " columns";
}

void StudyReference::sum_at_receivers(const Subject& subject, const Sinks& sinks, Comparison& results) {
  sampled_ = std::make_unique<SampledTruth>(subject.matrix(), subject.film(), wanted_.receivers,
                                            settings_.base.seed, sinks);
  results.reference_kind = "all " + std::to_string(subject.matrix().columns()) + " columns at " +
                           std::to_string(sampled_->rows()) + " receivers of " +
                           std::to_string(sampled_->pixels()) + " stratified pixels";
}

}  // namespace lumirank::study
