// What is said of properties and nested objects that nothing asked for.
#include "scenedesc/mitsuba/plugin.h"
#include "scenedesc/schema/close_name.h"

namespace lumirank::scenedesc::mitsuba {

void Plugin::warn_unused(const Child& child) {
  const std::string& tag = child.target->tag;
  const std::string as = child.name.empty() ? "" : " \"" + child.name + "\"";
  if (tag == "subsurface")
    return reader_.warn(child.element->where, "subsurface scattering of " + title(),
                        "the surface's own BSDF");
  if (child.target->find("type") && tag != "spectrum")
    return reader_.warn(
        child.element->where,
        "the <" + tag + " type=\"" + *child.target->find("type") + "\">" + as + " in " + title(), "");
  if (child.name.empty()) return reader_.warn(child.element->where, "a <" + tag + "> in " + title(), "");
  const std::string close = close_name(snake_case(child.name), asked_);
  const std::string* written = child.element->find("name");
  reader_.warn(child.element->where,
               "the property \"" + (written ? *written : child.name) + "\" of " + title() +
                   (close.empty() ? "" : " (did you mean \"" + close + "\"?)"),
               "");
}

void Plugin::finish() {
  for (const Child& child : children_)
    if (!child.used) warn_unused(child);
}

}  // namespace lumirank::scenedesc::mitsuba
