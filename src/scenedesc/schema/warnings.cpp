#include "scenedesc/schema/warnings.h"

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

void missing_file(SceneDesc& scene, const ReadOptions& options, const SourceLocation& where,
                  const std::string& what, const std::string& stand_in) {
  if (!options.allow_missing || options.strict)
    throw InputError(where, what,
                     options.allow_missing ? "--strict is given: check the name"
                                           : "check the name, or let a stand-in be shown (--allow-missing)");
  scene.warnings.push_back({where, what, stand_in});
}

}  // namespace lumirank::scenedesc
