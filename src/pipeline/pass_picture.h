// The picture of a render in passes: the mean of what surfaces send, and emission by film samples of its own.
#pragma once

#include <optional>

#include "image/image.h"
#include "lumirank/settings.h"
#include "pipeline/develop.h"
#include "pipeline/paths_beside.h"
#include "pipeline/picture_denoising.h"
#include "pipeline/picture_mean.h"
#include "pipeline/rest_tracing.h"

namespace lumirank::pipeline {

class PassPicture {
 public:
  // Settings and choices must outlive this.
  PassPicture(const RenderSettings& settings, const View& view, methods::TimedChoices& choices,
              const Sinks& sinks)
      : settings_(settings),
        parts_(wanted_parts(settings.view.only)),
        denoising_(settings, view, choices, sinks),
        whole_(denoising_.filtered(view)) {}

  const PictureDenoising& denoising() const { return denoising_; }
  void make_smaller(int divisor) { denoising_.make_smaller(divisor); }

  // Before any pass: what a denoiser asks of all pixels, with a recipe whose seeds are for film samples;
  // `left`: seconds of the budget, 0 without one. False if it was cancelled.
  bool begin(const world::World& world, const Recipe& recipe, double left, const Sinks& sinks);

  struct Pass {
    int number;     // how often all pixels have been shown before
    int wanted;     // so many numbers
    double weight;  // in the mean
    film::PixelLattice pixels;
    bool begins;  // showing all pixels once more
  };
  // `sent`: what surfaces send. `film`: as the pass had it, with a recipe as for begin(). False if it was
  // cancelled.
  bool add(const Pass& pass, const image::Image& sent, const FilmInput& film, const Sinks& sinks);

  // Features of one sample more, for who adds paths.
  bool trace_another(int number, const Sinks& sinks) { return denoising_.trace_another(number, sinks); }

  // Relative L1 of the mean's noise (PictureMean).
  double noise() const { return mean_.noise(); }
  // What surfaces send by passes and `rest`; and its noise, with two passes at least.
  image::Image sent(const RestTracing& rest) const;
  NoisyPicture with_noise(const RestTracing& rest) const;
  // With the emission that few film samples find, by mirrors or out of focus; with what is seen sharply.
  image::Image with_noisy_emission(image::Image sent) const;
  image::Image with_emission(image::Image sent) const;
  // The same of the size that was asked for, where that is larger: without noise.
  image::Image enlarged_with_emission(image::Image sent) const;
  // A difference of halves that has with_noisy_emission()'s part for noise.
  image::Image with_emission_as_noise(image::Image difference) const;

 private:
  image::Image noisy_emission(const image::Image& sent) const;
  image::Image emission_of_pass(int wanted, const FilmInput& film) const;

  const RenderSettings& settings_;
  FilmParts parts_;
  PictureDenoising denoising_;
  View whole_;
  PictureMean mean_;      // of what surfaces send
  PictureMean emission_;  // without a denoiser
};

}  // namespace lumirank::pipeline
