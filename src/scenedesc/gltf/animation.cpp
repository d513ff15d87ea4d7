#include "scenedesc/gltf/animation.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <utility>

namespace lumirank::scenedesc::gltf {
namespace {

using Steps = std::vector<std::string>;

// "/nodes/0/translation" → its steps (RFC 6901).
Steps steps_of(const Element& pointer) {
  const std::string& text = pointer.text();
  if (!text.starts_with('/'))
    pointer.fail("does not begin with a slash", "give a JSON pointer: /nodes/0/rotation");
  Steps steps;
  for (std::size_t begin = 1; begin <= text.size();) {
    const std::size_t end = std::min(text.find('/', begin), text.size());
    steps.push_back(text.substr(begin, end - begin));
    begin = end + 1;
  }
  for (std::string& step : steps)
    for (const auto& [code, meaning] : {std::pair{"~1", "/"}, std::pair{"~0", "~"}})
      for (std::size_t at = step.find(code); at != std::string::npos; at = step.find(code, at + 1))
        step.replace(at, 2, meaning);
  return steps;
}

// One step down; null if there is nothing.
const Json* below(const Json& json, const std::string& step) {
  if (json.kind == Json::Kind::object) return json.find(step);
  std::size_t index = 0;
  const auto [end, status] = std::from_chars(step.data(), step.data() + step.size(), index);
  if (json.kind != Json::Kind::list || status != std::errc{} || end != step.data() + step.size() ||
      index >= json.items.size())
    return nullptr;
  return &json.items[index];
}
Json* below(Json& json, const std::string& step) {
  return const_cast<Json*>(below(std::as_const(json), step));
}

Json number_at(double value, int line) {
  Json json;
  json.kind = Json::Kind::number;
  json.number = value, json.line = line;
  return json;
}

// False if the file, as other properties have made it, has no such place.
bool set(Json& document, const Steps& path, Json value) {
  Json* json = &document;
  for (std::size_t k = 0; k + 1 < path.size() && json; ++k) json = below(*json, path[k]);
  if (!json) return false;
  if (Json* found = below(*json, path.back())) {
    *found = std::move(value);
    return true;
  }
  if (json->kind != Json::Kind::object) return false;
  json->keys.push_back(path.back());
  json->items.push_back(std::move(value));
  return true;
}

// Spherical interpolation by the shorter way (glTF 2.0, appendix C.4); turns of less than 10⁻⁴ are straight.
void turn_between(const float* from, const float* to, double t, std::vector<double>& out) {
  double cosine = 0;
  for (std::size_t c = 0; c < 4; ++c) cosine += static_cast<double>(from[c]) * static_cast<double>(to[c]);
  const double sign = cosine < 0 ? -1 : 1, angle = std::acos(std::min(std::abs(cosine), 1.0));
  double first = 1 - t, second = t;
  if (angle > 1e-4)
    first = std::sin(angle * (1 - t)) / std::sin(angle), second = std::sin(angle * t) / std::sin(angle);
  for (std::size_t c = 0; c < 4; ++c)
    out[c] = first * static_cast<double>(from[c]) + sign * second * static_cast<double>(to[c]);
}

std::string name_of(const Element& root, const Steps& path) {
  std::string name;
  for (const std::string& step : path)
    name += !step.empty() && std::isdigit(static_cast<unsigned char>(step[0])) ? "[" + step + "]"
            : name.empty()                                                     ? step
                                                                               : "." + step;
  if (path.size() == 3 && path[0] == "nodes") {
    const Json* node = below(root.json(), path[0]);
    if (node) node = below(*node, path[1]);
    const Json* named = node ? node->find("name") : nullptr;
    const std::string own = named ? named->text : "";
    name = "nodes[" + path[1] + "]" + (own.empty() ? "" : " (" + own + ")") + ": " + path[2];
  }
  return name;
}

}  // namespace

std::vector<double> Animation::Track::at(double seconds) const {
  const bool cubic = interpolation == Interpolation::cubic;
  const std::size_t stride = components * (cubic ? 3 : 1), own = cubic ? components : 0;
  std::vector<double> out(components);
  const auto value = [&](std::size_t key) { return &values[key * stride + own]; };
  const auto next = static_cast<std::size_t>(
      std::upper_bound(times.begin(), times.end(), seconds,
                       [](double s, float key) { return s < static_cast<double>(key); }) -
      times.begin());
  if (next == 0 || next == times.size() || interpolation == Interpolation::step) {
    const float* held = value(next == 0 ? 0 : next - 1);
    for (std::size_t c = 0; c < components; ++c) out[c] = static_cast<double>(held[c]);
    return out;
  }
  const std::size_t k = next - 1;
  const double span = static_cast<double>(times[next]) - static_cast<double>(times[k]);
  const double t = (seconds - static_cast<double>(times[k])) / span;
  if (interpolation == Interpolation::linear && is_rotation) {
    turn_between(value(k), value(next), t, out);
    return out;
  }
  const double t2 = t * t, t3 = t2 * t;
  for (std::size_t c = 0; c < components; ++c) {
    const double a = static_cast<double>(value(k)[c]), b = static_cast<double>(value(next)[c]);
    if (!cubic) {
      out[c] = a + t * (b - a);
      continue;
    }
    // Appendix C.5: each key has its incoming tangent, its value, its outgoing tangent.
    const double leaving = static_cast<double>(values[k * stride + 2 * components + c]),
                 arriving = static_cast<double>(values[next * stride + c]);
    out[c] = (2 * t3 - 3 * t2 + 1) * a + span * (t3 - 2 * t2 + t) * leaving + (3 * t2 - 2 * t3) * b +
             span * (t3 - t2) * arriving;
  }
  return out;
}

Animation::Animation(const Element& root, Accessors& accessors, const std::string& clip)
    : root_(root), accessors_(accessors) {
  const std::vector<Element> animations = root.list("animations");
  if (animations.empty()) {
    if (!clip.empty() && clip != "*")
      throw InputError(root.where(), "the file has no clip '" + clip + "': it has no animations",
                       "leave out --clip");
    return;
  }
  const std::vector<std::string> names = clip_names(root);
  bool found = false;
  for (std::size_t k = 0; k < animations.size(); ++k) {
    if (clip != "*" && (clip.empty() ? k > 0 : names[k] != clip || found)) continue;
    found = true;
    add_clip(animations[k]);
  }
  if (!found) {
    std::string list;
    for (const std::string& name : names) list += (list.empty() ? "" : ", ") + name;
    throw InputError(animations[0].where(), "the file has no clip '" + clip + "'", "it has " + list);
  }
  begin_ = tracks_.empty() ? 0 : static_cast<double>(tracks_[0].times.front()), end_ = begin_;
  for (const Track& track : tracks_) {
    begin_ = std::min(begin_, static_cast<double>(track.times.front()));
    end_ = std::max(end_, static_cast<double>(track.times.back()));
    moving_.push_back(name_of(root_, track.path));
  }
}

void Animation::add_clip(const Element& animation) {
  for (const Element& channel : animation.list("channels")) add_channel(animation, channel);
}

void Animation::add_channel(const Element& animation, const Element& channel) {
  Track track = target_of(channel);
  if (track.path.empty()) return;
  for (const Track& other : tracks_)
    if (other.path == track.path)
      channel.fail("moves " + name_of(root_, track.path) + ", which another channel moves",
                   "choose one clip with --clip");
  const std::vector<Element> samplers = animation.list("samplers");
  const Element index = channel.at("sampler");
  set_keys(
      samplers.at(static_cast<std::size_t>(index.integer(0, static_cast<std::int64_t>(samplers.size()) - 1))),
      track);
  if (const std::size_t wanted = component_count(channel, track); track.components != wanted)
    channel.fail("has values of " + std::to_string(track.components) + " numbers",
                 name_of(root_, track.path) + " has " + std::to_string(wanted));
  tracks_.push_back(std::move(track));
}

Animation::Track Animation::target_of(const Element& channel) const {
  Track track;
  track.line = channel.where().line;
  const Element target = channel.at("target"), path = target.at("path");
  if (const auto pointer = target.extension("KHR_animation_pointer"); pointer && path.text() == "pointer") {
    const Element where = pointer->at("pointer");
    track.path = steps_of(where);
  } else {
    const auto node = target.find("node");
    if (!node) return track;  // another extension's target: to be left alone (section 3.11)
    const std::vector<Element> nodes = root_.list("nodes");
    const auto k = static_cast<std::size_t>(node->integer(0, static_cast<std::int64_t>(nodes.size()) - 1));
    if (path.text() != "translation" && path.text() != "rotation" && path.text() != "scale" &&
        path.text() != "weights")
      path.fail("is \"" + path.text() + "\"", "translation, rotation, scale and weights can be animated");
    if (path.text() != "weights" && nodes[k].has("matrix"))
      nodes[k].fail("has a matrix and is animated", "give translation, rotation and scale");
    track.path = {"nodes", std::to_string(k), path.text()};
  }
  return track;
}

void Animation::set_keys(const Element& sampler, Track& track) {
  const std::string how = sampler.text("interpolation", "LINEAR");
  if (how == "STEP")
    track.interpolation = Interpolation::step;
  else if (how == "CUBICSPLINE")
    track.interpolation = Interpolation::cubic;
  else if (how != "LINEAR")
    sampler.at("interpolation").fail("is \"" + how + "\"", "LINEAR, STEP and CUBICSPLINE are known");
  const Element input = sampler.at("input"), output = sampler.at("output");
  track.times = accessors_.floats(input, 1, 1).values;
  if (track.times.empty()) input.fail("has no keys", "give at least one");
  for (std::size_t k = 0; k < track.times.size(); ++k) {
    if (!std::isfinite(track.times[k]) || track.times[k] < 0)
      input.fail("has a key time that is negative or not finite (key " + std::to_string(k) + ")",
                 "give seconds from 0 on");
    if (k > 0 && !(track.times[k] > track.times[k - 1]))
      input.fail("has key times that do not rise (key " + std::to_string(k) + ")",
                 "sort the keys and keep one of equal times");
  }
  const Numbers numbers = accessors_.floats(output, 1, 16);
  const std::size_t values = track.times.size() * (track.interpolation == Interpolation::cubic ? 3 : 1);
  // Weights of morph targets are single numbers, one after the other.
  const bool whole = numbers.components > 1 ? numbers.count == values : numbers.count % values == 0;
  if (numbers.values.empty() || !whole)
    output.fail("has " + std::to_string(numbers.count) + " values for " + std::to_string(track.times.size()) +
                    " keys",
                track.interpolation == Interpolation::cubic ? "CUBICSPLINE wants three for each key"
                                                            : "give one for each key");
  track.values = numbers.values;
  track.components = numbers.values.size() / values;
}

// Numbers of the property; sets how it is written into the file.
std::size_t Animation::component_count(const Element& channel, Track& track) const {
  const std::string& name = track.path.back();
  const bool of_node = track.path.size() == 3 && track.path[0] == "nodes";
  const Json* parent = &root_.json();
  for (std::size_t k = 0; k + 1 < track.path.size() && parent; ++k) parent = below(*parent, track.path[k]);
  if (!parent || (parent->kind != Json::Kind::object && !below(*parent, name)))
    channel.fail("points to " + name_of(root_, track.path) + ", which the file does not have",
                 "write the property that is animated");
  track.is_rotation = of_node && name == "rotation";
  track.is_list = true;
  if (name == "weights") return track.components;  // as many as targets, which the primitive checks
  if (of_node && (name == "translation" || name == "scale")) return 3;
  if (track.is_rotation) return 4;
  // Any other: as it stands in the file, or what its values are.
  const Json* found = below(*parent, name);
  if (!found) {
    track.is_list = track.components > 1;
    return track.components;
  }
  track.is_list = found->kind == Json::Kind::list, track.is_flag = found->kind == Json::Kind::boolean;
  const bool numbers = track.is_list
                           ? std::all_of(found->items.begin(), found->items.end(),
                                         [](const Json& item) { return item.kind == Json::Kind::number; })
                           : track.is_flag || found->kind == Json::Kind::number;
  if (!numbers || (track.is_list && found->items.empty()))
    channel.fail("points to " + name_of(root_, track.path) + ", which is no number", "animate numbers");
  return track.is_list ? found->items.size() : 1;
}

Json Animation::at(const Json& document, double seconds) const {
  Json posed = document;
  for (const Track& track : tracks_) {
    const std::vector<double> values = track.at(seconds);
    Json json;
    json.line = track.line;
    if (track.is_list) {
      json.kind = Json::Kind::list;
      for (const double v : values) json.items.push_back(number_at(v, track.line));
    } else {
      json = number_at(track.is_flag ? (values[0] != 0 ? 1.0 : 0.0) : values[0], track.line);
      if (track.is_flag) json.kind = Json::Kind::boolean;
    }
    if (!set(posed, track.path, std::move(json)))
      throw InputError({root_.file(), track.line},
                       name_of(root_, track.path) + " is moved, and another channel replaces what it is in",
                       "choose one clip with --clip");
  }
  return posed;
}

std::vector<std::string> clip_names(const Element& root) {
  std::vector<std::string> names;
  for (const Element& animation : root.list("animations"))
    names.push_back(animation.text("name", std::to_string(names.size())));
  return names;
}

}  // namespace lumirank::scenedesc::gltf
