#include "lumirank/compare.h"

#include "api/scene.h"
#include "base/error.h"
#include "study/comparison.h"

namespace lumirank {

Comparison compare(const Scene& scene, const CompareSettings& settings, const std::string& folder,
                   const Sinks& sinks) {
  validate(settings.base);
  if (settings.base.view.is_open())
    throw InputError("pictures with an open shutter are not compared here",
                     "leave out --shutter; 'lumirank error' compares two files");
  return study::compare({scene.impl().desc, scene.impl().options.strict, scene.files()}, settings, folder,
                        sinks);
}

}  // namespace lumirank
