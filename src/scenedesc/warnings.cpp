#include "scenedesc/warnings.h"

namespace lumirank::scenedesc {

void add_warning(SceneDesc& scene, const ReadOptions& options, const SourceLocation& where,
                 const std::string& what, const std::string& used_instead) {
  if (options.strict)
    throw InputError(where, "Lumirank does not have " + what,
                     used_instead.empty() ? "without --strict it is left out"
                                          : "without --strict this is used: " + used_instead);
  scene.warnings.push_back({where, what, used_instead});
}

void add_note(SceneDesc& scene, const SourceLocation& where, const std::string& what) {
  scene.warnings.push_back({where, what, "", true});
}

}  // namespace lumirank::scenedesc
