// Division of a time budget among the stages of a render: a pure function of what pilots measured, so that
// tests can make up any machine and any scene.
#pragma once

#include <cstddef>
#include <string>

namespace lumirank::pipeline {

// Seconds, measured on a small part of each stage. A film sample is one receiver's share of a pixel, but for
// those that are apart from receivers (film_sample, film_samples).
struct TimeCosts {
  double passed = 0;       // since the scene began to be read: that, building, and the pilots themselves
  double pixels = 0;       // of the film that is traced, with what the filter reaches around a crop
  double receiver = 0;     // per film sample: following the eye's ray
  double film_sample = 0;  // of those apart from receivers: the same, and finding its receivers
  double direct = 0;       // per film sample: one sample of traced direct light; 0: nothing is traced
  double column = 0;       // per film sample: one column of the matrix
  double develop = 0;      // per film sample: from values to a picture
  double light = 0;        // per virtual light, features of the matrix included
  double rest = 0;         // per pixel: one path of what columns cannot carry
};

struct TimeWishes {
  double budget = 0;
  int spp = 4;
  bool spp_given = false;  // by hand: kept whatever it takes
  int film_samples = 0;
  bool film_samples_given = false;
  std::size_t lights = 100000;
  bool lights_given = false;
  int rest_paths = 0;           // per pixel; 0: none are traced
  int layers = 0;               // pictures beside the first
  bool may_be_smaller = false;  // the film: it is enlarged afterwards
};

struct TimePlan {
  int divisor = 1;       // of the film's width and height, where there is no time for all of its pixels
  int spp = 4;           // fewer than wished for where time is short, more where it abounds
  int film_samples = 0;  // fewer than wished for, or none, where time is short
  std::size_t lights = 100000;
  double direct_seconds = 0, rest_seconds = 0;  // at first; what is left over at the end is added
  double film_seconds = 0;                      // kept back
  // Of the pilot's columns, that fit what is left to the method, for all receivers; infinite if there are
  // none.
  double columns = 0;
  bool build_alone = false;  // the budget was over before there was anything to plan
  double enough = 0;         // the budget with which nothing would have been lowered
  std::string shortage;      // what the budget does not hold, for a person; empty if nothing
};

TimePlan plan_time(const TimeWishes& wishes, const TimeCosts& costs);

// What a stage may take now that it begins: as planned, but no more than a quarter of what really is left
// before the film, for a stage before it may have taken longer than its pilot said.
double stage_seconds(double planned, double left);

// Of the budget what is aimed at: what ends late must not exceed it.
constexpr double kTimeAim = 0.97;

}  // namespace lumirank::pipeline
