// In which participating medium the light of each emitter starts. Scene files do not say; surfaces say it
// that divide media, and the camera.
#pragma once

#include <vector>

#include "world/world.h"

namespace lumirank::world {

class EmitterMedia {
 public:
  // `eye`, `eye_medium`: where the camera is, and in what (-1: empty space). The world must outlive it.
  EmitterMedia(const World& world, Vec3f eye, int eye_medium);

  // Of light that starts along `ray`. An emitter's own surface tells, if it divides media; else the first
  // surface that does on the way to the eye, or in another direction where something opaque is before it:
  // walls around a medium need not divide it from what is behind them. From far away: the first on the way.
  int of(int emitter, const geometry::Ray& ray) const;

 private:
  struct Found {
    int medium;
    bool sure;  // nothing opaque was passed on the way to a surface that divides media, or to the eye
  };
  Found look(geometry::Ray ray) const;
  int around(Vec3f place) const;

  const World& world_;
  Vec3f eye_;
  int eye_medium_;
  std::vector<int> near_;  // by emitter; empty where no surface divides media
};

}  // namespace lumirank::world
