// Transforms with key frames.
#include <cmath>

#include "scenedesc/mitsuba/reader.h"
#include "scenedesc/schema/keyed_transform.h"
#include "scenedesc/schema/warnings.h"

namespace lumirank::scenedesc::mitsuba {

Transform Reader::animated(const Element& animation, const std::string& title) {
  std::vector<TransformKey> keys;
  for (const auto& child : animation.children) {
    if (child->tag != "transform")
      throw InputError(child->where, "<" + child->tag + "> in an <animation>",
                       "only <transform time=\"…\"> can be there");
    const double time = parse_double(child->require("time"), child->where, "time of <transform>");
    if (!std::isfinite(time) || (!keys.empty() && !(time > keys.back().seconds)))
      throw InputError(child->where, "the key times of an <animation> do not rise",
                       "sort the keys and keep one of equal times");
    keys.push_back({time, parse_transform(*child)});
  }
  if (keys.empty()) throw InputError(animation.where, "the <animation> has no <transform>");
  if (keys.size() > 1) {
    add_motion(title + ": to_world", keys.front().seconds, keys.back().seconds);
    if (!options_.time && is_new("animation"))
      add_note(scene_, animation.where,
               "animations: every one is shown at its first key; --at SECONDS shows another moment");
  }
  return transform_at(keys, options_.time.value_or(keys.front().seconds));
}

}  // namespace lumirank::scenedesc::mitsuba
