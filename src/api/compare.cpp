#include "lumirank/compare.h"

#include "api/scene.h"
#include "study/comparison.h"

namespace lumirank {

Comparison compare(const Scene& scene, const CompareSettings& settings, const std::string& folder,
                   const Sinks& sinks) {
  validate(settings.base);
  return study::compare({scene.impl().desc, scene.impl().options.strict, scene.files()}, settings, folder,
                        sinks);
}

}  // namespace lumirank
