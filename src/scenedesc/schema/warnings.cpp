#include "scenedesc/schema/warnings.h"

namespace lumirank::scenedesc {

void add_note(SceneDesc& scene, const SourceLocation& where, const std::string& what) {
  scene.warnings.push_back({where, what, "", true});
}

}  // namespace lumirank::scenedesc
