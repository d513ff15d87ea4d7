// Takes the noise out of a rendered picture by Intel's Open Image Denoise 2, which is loaded at run time if
// it is there. A denoised picture is biased, and its error is not what a method states for its own.
#pragma once

#include <memory>
#include <string>

#include "denoise/oidn.h"
#include "image/image.h"

namespace lumirank::denoise {

struct Found;

// What features are: without noise, so that each of their edges is one of the picture; with some, taken with
// care; or with some, and each denoised by itself first, which takes three times as long.
enum class Features { clean, noisy, prefiltered };

class Denoiser {
 public:
  // The denoiser of this process, or why there is none. The first call looks for it and loads it; all later
  // ones, of whatever thread, get the same answer. Looked at are, in this order: what the environment
  // variable LUMIRANK_DENOISER names, a folder (with or without a `lib` in it) or the library's file, and if
  // it is set nothing else; $XDG_DATA_HOME/lumirank/denoiser (~/.local/share/lumirank/denoiser), where `make
  // denoiser` puts it; where the system's loader looks.
  static const Found& find();

  // The same, looked for anew.
  static Found find_anew();

  // "2.5.1", for reports.
  const std::string& version() const { return version_; }

  // The picture `noisy` (linear radiance in any unit; what is negative counts as 0) without its noise, of the
  // same size. The features say where the edges are, and each may be null, but normals come with an albedo
  // only:
  //   albedo  what part of the light the surface throws back, [0, 1]
  //   normal  of the surface, in any fixed frame, mean over the pixel: of length 1 or shorter, [-1, 1]
  // both of the size of `noisy` and black where there is no surface. What a reconstruction filter with
  // negative lobes lets overshoot is cut to these ranges.
  //
  // The library's network makes something else of a picture that is turned. `orientations`, 1 to 4, is in how
  // many the picture is denoised, of which the mean is given: some of what is wrong in each is not in
  // another. Each takes as long as the first. Of four, the turned picture's is the picture's turned, but for
  // rounding.
  //
  // Runs on current_threads() threads (base/parallel.h), and several calls may run at a time. The same
  // pictures give the same bits, on any number of threads; another processor or another version of the
  // library may round otherwise.
  //
  // Memory besides the pictures: some 0.8 KB for each pixel, but not more than 3.2 GB, as larger ones are
  // taken in overlapping tiles. Time with both features: on two cores with AVX2 5 s for 10⁶ pixels,
  // with prefiltered ones 15 s.
  //
  // Throws InputError for pictures that are empty, of different sizes or not finite everywhere, and for
  // normals without albedo or a number of orientations that there is not; std::bad_alloc; InternalError with
  // the library's words if it fails otherwise.
  image::Image denoise(const image::Image& noisy, const image::Image* albedo = nullptr,
                       const image::Image* normal = nullptr, Features features = Features::noisy,
                       int orientations = 1) const;

 private:
  Denoiser(const Oidn& functions, std::string version);

  Oidn oidn_;
  std::string version_;
};

struct Found {
  std::shared_ptr<const Denoiser> denoiser;  // null: there is none that can be used
  std::string trouble;                       // why, and what helps; empty if there is one
  bool absent = false;  // there is none at all (and none was asked for by LUMIRANK_DENOISER)
};

}  // namespace lumirank::denoise
