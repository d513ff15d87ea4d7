// What is said of properties and nested objects that nothing asked for.
#include <algorithm>
#include <numeric>

#include "scenedesc/mitsuba/plugin.h"

namespace lumirank::scenedesc::mitsuba {

namespace {

// Number of letters to insert, remove or change (Levenshtein).
std::size_t edit_distance(const std::string& a, const std::string& b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 0; i < a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i + 1;
    for (std::size_t j = 0; j < b.size(); ++j) {
      const std::size_t change = diagonal + (a[i] != b[j]);
      diagonal = row[j + 1];
      row[j + 1] = std::min({change, row[j] + 1, diagonal + 1});
    }
  }
  return row.back();
}

}  // namespace

void Plugin::warn_unused(const Child& child) {
  const std::string& tag = child.target->tag;
  const std::string as = child.name.empty() ? "" : " \"" + child.name + "\"";
  if (tag == "medium")
    return reader_.warn(child.element->where, "participating media (the medium" + as + " of " + title() + ")",
                        "empty space");
  if (tag == "subsurface")
    return reader_.warn(child.element->where, "subsurface scattering of " + title(),
                        "the surface's own BSDF");
  if (child.target->find("type") && tag != "spectrum")
    return reader_.warn(
        child.element->where,
        "the <" + tag + " type=\"" + *child.target->find("type") + "\">" + as + " in " + title(), "");
  if (child.name.empty()) return reader_.warn(child.element->where, "a <" + tag + "> in " + title(), "");
  std::string close, snake = snake_case(child.name);
  std::size_t best = 3;
  for (const std::string& name : child.name.size() > 100 ? std::set<std::string>{} : asked_) {
    const std::size_t distance = edit_distance(snake, name);
    if (distance < best) best = distance, close = name;
  }
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
