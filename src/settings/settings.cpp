// The one table of render settings: the command line, JSON and `--help` are made from it.
#include "lumirank/settings.h"

#include <charconv>
#include <functional>
#include <nlohmann/json.hpp>

#include "lumirank/error.h"
#include "methods/method.h"

namespace lumirank {
namespace {

struct Row {
  Field field;
  std::function<void(RenderSettings&, const std::string&)> set;
  std::function<std::string(const RenderSettings&)> get;
};

template <typename T>
T parse_number(const std::string& key, const std::string& text) {
  T value{};
  const auto [end, code] = std::from_chars(text.data(), text.data() + text.size(), value);
  bool ok = code == std::errc{} && end == text.data() + text.size();
  if constexpr (std::is_floating_point_v<T>) ok = ok && std::isfinite(value);
  if (!ok)
    throw InputError("'" + text + "' is not a valid number for '" + key + "'",
                     std::is_integral_v<T> ? "give a whole number, in digits only" : "");
  return value;
}

std::string format_number(double v) {
  char buffer[32];
  const auto [end, code] = std::to_chars(buffer, buffer + sizeof buffer, v);
  return code == std::errc{} ? std::string(buffer, end) : std::string{};
}

// With its empty parts: 800xx600 is not a size.
std::vector<std::string> split_settings(const std::string& text, char separator) {
  std::vector<std::string> parts;
  std::size_t begin = 0;
  while (begin <= text.size()) {
    const std::size_t end = std::min(text.find(separator, begin), text.size());
    parts.push_back(text.substr(begin, end - begin));
    begin = end + 1;
  }
  return parts;
}

// The names of an enumeration's values, in their order.
template <typename E>
struct EnumNames;
template <>
struct EnumNames<LightPart> {
  static constexpr const char* names[] = {"all", "direct", "indirect"};
};
template <>
struct EnumNames<LightType> {
  static constexpr const char* names[] = {"point", "diffuse-point", "sphere"};
};
template <>
struct EnumNames<SphereIndicator> {
  static constexpr const char* names[] = {"disc", "cosine"};
};
template <>
struct EnumNames<SphereStrategies> {
  static constexpr const char* names[] = {"all", "cone"};
};
template <>
struct EnumNames<SphereSamples> {
  static constexpr const char* names[] = {"overlap", "cone"};
};
template <>
struct EnumNames<DirectLight> {
  static constexpr const char* names[] = {"auto", "matrix", "traced"};
};
template <>
struct EnumNames<RestOfPaths> {
  static constexpr const char* names[] = {"auto", "skip", "trace"};
};
template <>
struct EnumNames<ReferencePaths> {
  static constexpr const char* names[] = {"all", "columns", "rest"};
};
template <>
struct EnumNames<ToneMap> {
  static constexpr const char* names[] = {"none", "reinhard", "agx"};
};

template <typename E>
std::string names_of() {
  std::string all;
  for (const char* name : EnumNames<E>::names) all += (all.empty() ? "" : "|") + std::string(name);
  return all;
}

template <typename E>
E parse_enum(const std::string& key, const std::string& text) {
  int value = 0;
  for (const char* name : EnumNames<E>::names) {
    if (text == name) return static_cast<E>(value);
    ++value;
  }
  throw InputError("'" + text + "' is not a value of '" + key + "'", "choose one of " + names_of<E>());
}

// Members of the groups: `at(settings)` is the value itself.
template <auto Group, auto Member>
struct At {
  auto& operator()(RenderSettings& s) const { return s.*Group.*Member; }
  const auto& operator()(const RenderSettings& s) const { return s.*Group.*Member; }
};
template <auto Member>
struct Top {
  auto& operator()(RenderSettings& s) const { return s.*Member; }
  const auto& operator()(const RenderSettings& s) const { return s.*Member; }
};

template <typename T>
struct Value {
  using type = T;
};
template <typename T>
struct Value<std::optional<T>> {
  using type = T;
};

// An optional number that is not set reads as its default, and is left unset by a default that is not given.
template <typename Place>
Row number(Field field, Place at, double low, double high) {
  using Held = std::remove_cvref_t<decltype(at(std::declval<RenderSettings&>()))>;
  using T = typename Value<Held>::type;
  const std::string key = field.key;
  field.type = std::is_floating_point_v<T> ? "number" : "integer";
  const T fallback = parse_number<T>(key, field.default_text);
  return {field,
          [=](RenderSettings& s, const std::string& text) {
            const T value = parse_number<T>(key, text);
            if (static_cast<double>(value) < low || static_cast<double>(value) > high)
              throw InputError("'" + key + "' is " + text + "; it must lie in " + field.range);
            at(s) = value;
          },
          [=](const RenderSettings& s) {
            T value = fallback;
            if constexpr (std::is_same_v<Held, T>)
              value = at(s);
            else
              value = at(s).value_or(fallback);
            if constexpr (std::is_floating_point_v<T>)
              return format_number(value);
            else
              return std::to_string(value);
          }};
}

template <typename Place>
Row choice(Field field, Place at) {
  using E = std::remove_cvref_t<decltype(at(std::declval<RenderSettings&>()))>;
  field.type = "choice";
  field.range = names_of<E>();
  const std::string key = field.key;
  return {field, [=](RenderSettings& s, const std::string& text) { at(s) = parse_enum<E>(key, text); },
          [=](const RenderSettings& s) {
            return std::string(EnumNames<E>::names[static_cast<std::size_t>(at(s))]);
          }};
}

template <typename Place>
Row text_field(Field field, Place at) {
  field.type = "text";
  return {field, [=](RenderSettings& s, const std::string& text) { at(s) = text; },
          [=](const RenderSettings& s) { return at(s); }};
}

Row method_row() {
  Field field{"method", "choice", "auto", "auto", "", "how the row sums of the matrix are estimated"};
  for (const auto& m : methods::all_methods()) field.range += "|" + m.name;
  return {field,
          [](RenderSettings& s, const std::string& text) {
            if (text != "auto") methods::find_method(text);  // throws with the list
            s.method.name = text;
          },
          [](const RenderSettings& s) { return s.method.name; }};
}

Row size_row() {
  return {{"size", "text", "", "WxH, each 1 … 65536", "pixels", "resolution; default: as the scene says"},
          [](RenderSettings& s, const std::string& text) {
            if (text.empty()) return void(s.view.width = s.view.height = 0);
            const auto parts = split_settings(text, 'x');
            if (parts.size() != 2) throw InputError("'" + text + "' is not a size", "write it as 800x600");
            const int w = parse_number<int>("size", parts[0]), h = parse_number<int>("size", parts[1]);
            if (w < 1 || h < 1 || w > 65536 || h > 65536)
              throw InputError("the size " + text + " is out of range", "width and height lie in 1 … 65536");
            s.view.width = w, s.view.height = h;
          },
          [](const RenderSettings& s) {
            return s.view.width > 0 ? std::to_string(s.view.width) + "x" + std::to_string(s.view.height)
                                    : std::string{};
          }};
}

Row crop_row() {
  return {{"crop", "text", "", "X,Y,W,H", "pixels", "render only this window of the film"},
          [](RenderSettings& s, const std::string& text) {
            if (text.empty()) return void(s.view.crop.fill(0));
            const auto parts = split_settings(text, ',');
            if (parts.size() != 4) throw InputError("'" + text + "' is not a crop", "write it as X,Y,W,H");
            for (std::size_t i = 0; i < 4; ++i) s.view.crop[i] = parse_number<int>("crop", parts[i]);
            if (s.view.crop[0] < 0 || s.view.crop[1] < 0 || s.view.crop[2] < 1 || s.view.crop[3] < 1)
              throw InputError("the crop " + text + " is negative or empty");
            if (*std::max_element(s.view.crop.begin(), s.view.crop.end()) > 65536)
              throw InputError("the crop " + text + " is out of range",
                               "no film is larger than 65536 pixels");
          },
          [](const RenderSettings& s) {
            if (s.view.crop[2] == 0) return std::string{};
            return std::to_string(s.view.crop[0]) + "," + std::to_string(s.view.crop[1]) + "," +
                   std::to_string(s.view.crop[2]) + "," + std::to_string(s.view.crop[3]);
          }};
}

bool known_aov(const std::string& name) {
  if (name.starts_with("light:") && name.size() > 6) return true;
  static const std::vector<std::string> names = {"direct", "indirect", "emission", "illuminance", "albedo",
                                                 "normal", "depth",    "position", "samples"};
  return std::find(names.begin(), names.end(), name) != names.end();
}

Row aov_row() {
  return {{"aov", "list", "",
           "direct,indirect,emission,illuminance,albedo,normal,depth,position,samples,light:NAME,light:*", "",
           "further EXR layers, separated by commas; light:NAME is the part of one emitter or group, light:* "
           "all of them"},
          [](RenderSettings& s, const std::string& text) {
            s.layers.clear();
            if (text.empty()) return;
            for (const auto& name : split_settings(text, ',')) {
              if (name.empty())
                throw InputError("'" + text + "' has an empty name among its AOVs",
                                 "write them as albedo,depth");
              if (!known_aov(name))
                throw InputError(
                    "'" + name + "' is not an AOV",
                    "choose from direct, indirect, emission, illuminance, albedo, normal, depth, position, "
                    "samples, light:NAME");
              if (std::find(s.layers.begin(), s.layers.end(), name) == s.layers.end())
                s.layers.push_back(name);
            }
          },
          [](const RenderSettings& s) {
            std::string joined;
            for (const auto& a : s.layers) joined += (joined.empty() ? "" : ",") + a;
            return joined;
          }};
}

const std::vector<Row>& table() {
  using S = RenderSettings;
  static const std::vector<Row> rows = [] {
    std::vector<Row> t;
    t.push_back(method_row());
    t.push_back(number(
        {"lights", "", "100000", "1 … 50000000", "lights",
         "virtual lights to generate, all kinds together; costs memory (about 400 B each) and time in rows"},
        At<&S::lights, &VirtualLightSettings::count>{}, 1, 5e7));
    t.push_back(choice({"light-type", "", "point", "", "", "kind of indirect virtual light"},
                       At<&S::lights, &VirtualLightSettings::type>{}));
    t.push_back(number({"radius-scale", "", "0", "0 … 1000", "",
                        "spherical lights: radius over the distance to the 10th nearest light; 0: by the "
                        "number of lights"},
                       At<&S::lights, &VirtualLightSettings::radius_scale>{}, 0, 1000));
    t.push_back(
        choice({"sphere-indicator", "", "disc", "", "",
                "spherical lights: what is taken for the lit surface close by; cosine: as in the paper"},
               At<&S::lights, &VirtualLightSettings::sphere_indicator>{}));
    t.push_back(choice({"sphere-strategies", "", "all", "", "",
                        "spherical lights: sample cone and both BSDFs, or the cone alone"},
                       At<&S::lights, &VirtualLightSettings::sphere_strategies>{}));
    t.push_back(
        choice({"sphere-samples", "", "overlap", "", "",
                "spherical lights: samples by the overlap of lobes and cone, or by the cone alone as in "
                "the paper"},
               At<&S::lights, &VirtualLightSettings::sphere_samples>{}));
    t.push_back(size_row());
    t.push_back(
        number({"spp", "", "4", "1 … 4096", "receivers per pixel", "film samples per pixel (4 = 2×2)"},
               At<&S::view, &ViewSettings::spp>{}, 1, 4096));
    t.push_back(
        number({"max-depth", "", "0", "-1 … 1000000", "bounces",
                "longest path, 1: emission only, 2: direct light; 0: as the scene says; -1: unlimited"},
               At<&S::view, &ViewSettings::max_depth>{}, -1, 1e6));
    t.push_back(
        number({"clamp", "", "0.03", "0 … 1e9", "", "bound on a_j·G·(π f_x)(π f_y) of one entry; 0: off"},
               At<&S::lights, &VirtualLightSettings::clamp>{}, 0, 1e9));
    t.push_back(
        choice({"only", "", "all", "", "", "leave out the other part"}, At<&S::view, &ViewSettings::only>{}));
    t.push_back(number({"seed", "", "1", "0 … 2^63", "", "fixes every random choice"}, Top<&S::seed>{}, 0,
                       9223372036854775808.0));
    t.push_back(number({"method-seed", "", "0", "0 … 2^63", "",
                        "other random choices of the method on the same lights and receivers; 0: as --seed"},
                       At<&S::method, &MethodSettings::seed>{}, 0, 9223372036854775808.0));
    t.push_back(number({"threads", "", "0", "0 … 1024", "threads", "0: all; the image does not depend on it"},
                       Top<&S::threads>{}, 0, 1024));
    t.push_back(number(
        {"time", "", "0", "0 … 1e7", "s", "time budget for seconds.total, divided among the stages; 0: none"},
        Top<&S::time>{}, 0, 1e7));
    t.push_back(number({"error", "", "0", "0 … 10", "",
                        "stop when the estimated relative error is below; 0: the method's default"},
                       At<&S::method, &MethodSettings::target_error>{}, 0, 10));
    t.push_back(choice({"direct", "", "auto", "", "",
                        "direct light at receivers: by columns, traced with multiple importance sampling, or "
                        "traced in sharp lobes (roughness below 0.15) and by columns in the others"},
                       At<&S::traced, &TracedLightSettings::direct>{}));
    t.push_back(number({"local-paths", "", "0", "0 … 1048576", "paths per receiver",
                        "trace the light that virtual lights blur, in sharp lobes and from close by, "
                        "instead of gathering it from columns (unbiased, noisy); 0: do not"},
                       At<&S::traced, &TracedLightSettings::local_paths>{}, 0, 1 << 20));
    t.push_back(number({"local-sharp", "", "0.3", "0 … 1", "roughness",
                        "with local-paths: lobes sharper than this are traced"},
                       At<&S::traced, &TracedLightSettings::local_sharp>{}, 0, 1));
    t.push_back(number({"local-near", "", "4", "0 … 1000", "radii",
                        "with local-paths, of spherical lights: places nearer than this are traced"},
                       At<&S::traced, &TracedLightSettings::local_near>{}, 0, 1000));
    t.push_back(choice({"rest", "", "auto", "", "",
                        "paths that columns cannot carry: leave out, add by path tracing (noisy), or add "
                        "where a pilot finds that they bring more than 0.5 % of the light"},
                       At<&S::traced, &TracedLightSettings::rest>{}));
    t.push_back(number({"compensate", "", "0", "0 … 1048576", "paths per pixel",
                        "give back what clamping took from indirect light by path tracing (unbiased, "
                        "noisy); 0: do not"},
                       At<&S::traced, &TracedLightSettings::compensate>{}, 0, 1 << 20));
    t.push_back(text_field({"camera", "", "", "", "", "id of the scene's sensor; default: the first"},
                           At<&S::view, &ViewSettings::camera>{}));
    t.push_back(crop_row());
    t.push_back(aov_row());
    return t;
  }();
  return rows;
}

const Row& find_row(const std::string& key) {
  for (const Row& row : table())
    if (row.field.key == key) return row;
  std::string valid;
  for (const Row& row : table()) valid += (valid.empty() ? "" : ", ") + row.field.key;
  throw InputError("there is no setting '" + key + "'", "the settings are " + valid);
}

}  // namespace

const std::vector<Field>& render_fields() {
  static const std::vector<Field> fields = [] {
    std::vector<Field> f;
    for (const Row& row : table()) f.push_back(row.field);
    return f;
  }();
  return fields;
}

void set_field(RenderSettings& settings, const std::string& key, const std::string& value) {
  find_row(key).set(settings, value);
}

std::string get_field(const RenderSettings& settings, const std::string& key) {
  return find_row(key).get(settings);
}

std::string to_json(const RenderSettings& settings) {
  nlohmann::ordered_json json;
  for (const Row& row : table()) json[row.field.key] = row.get(settings);
  json["set"] = nlohmann::ordered_json::object();
  for (const auto& [key, value] : settings.method.parameters) json["set"][key] = value;
  return json.dump();
}

RenderSettings render_settings_from_json(const std::string& text) {
  nlohmann::json json;
  try {
    json = nlohmann::json::parse(text);
  } catch (const nlohmann::json::exception& e) {
    throw InputError(std::string("the settings are not JSON: ") + e.what());
  }
  if (!json.is_object()) throw InputError("the settings must be a JSON object");
  RenderSettings settings;
  const auto as_text = [](const std::string& key, const nlohmann::json& value) {
    if (value.is_string()) return value.get<std::string>();
    if (value.is_number()) return value.dump();
    throw InputError("the value of '" + key + "' must be text or a number");
  };
  for (const auto& [key, value] : json.items()) {
    if (key == "set") {
      if (!value.is_object()) throw InputError("'set' must be an object of the method's parameters");
      for (const auto& [k, v] : value.items()) settings.method.parameters[k] = as_text(k, v);
    } else {
      set_field(settings, key, as_text(key, value));
    }
  }
  // A report names every setting, asked for or not.
  if (settings.lights.count == VirtualLightSettings::kDefaultCount) settings.lights.count.reset();
  if (settings.view.spp == ViewSettings::kDefaultSpp) settings.view.spp.reset();
  return settings;
}

RenderSettings render_settings_from_report(const std::string& report) {
  const nlohmann::json json = nlohmann::json::parse(report, nullptr, false);
  if (!json.is_object() || !json.contains("parameters"))
    throw InputError("this is not a report of a render", "give the file that --report wrote");
  RenderSettings settings = render_settings_from_json(json["parameters"].dump());
  if (settings.time <= 0) return settings;
  try {
    settings.choices = json.at("choices").get<decltype(settings.choices)>();
  } catch (const nlohmann::json::exception&) {
    throw InputError("the report of a run under --time lacks the choices that the clock made",
                     json.value("stopped", "") == "cancelled"
                         ? "the run was interrupted: it cannot be replayed"
                         : "render again with --report");
  }
  return settings;
}

ReferencePaths reference_paths(const std::string& name) { return parse_enum<ReferencePaths>("paths", name); }
std::string to_text(ReferencePaths paths) {
  return EnumNames<ReferencePaths>::names[static_cast<std::size_t>(paths)];
}
ToneMap tone_map(const std::string& name) { return parse_enum<ToneMap>("tonemap", name); }

void validate(const RenderSettings& settings) {
  for (const Row& row : table()) {  // ranges also hold for values that were assigned directly
    RenderSettings scratch;
    row.set(scratch, row.get(settings));
  }
  if (!settings.choices.empty() && settings.time <= 0)
    throw InputError("choices of a timed run need its time budget", "set 'time', or clear the choices");
  if (settings.traced.local_paths > 0) {
    if (settings.traced.direct == DirectLight::matrix && settings.traced.local_sharp > 0)
      throw InputError("'local-paths' trace the direct light of sharp lobes too",
                       "leave out 'direct matrix', or set 'local-sharp' to 0");
    if (settings.traced.compensate > 0)
      throw InputError("'compensate' gives back light that 'local-paths' have traced",
                       "leave out one of them");
  }
  if (settings.traced.compensate > 0) {
    const auto refuse = [](const char* what, const char* remedy) {
      throw InputError(std::string("'compensate' ") + what, remedy);
    };
    if (settings.time > 0) refuse("cannot keep to a time budget", "leave out 'time', or 'compensate'");
    if (!(settings.lights.clamp > 0))
      refuse("has nothing to give back without clamping", "set 'clamp' above 0");
    if (settings.lights.type == LightType::sphere)
      refuse("is for point lights", "set 'light-type' to point or diffuse-point");
    if (settings.view.only == LightPart::direct)
      refuse("is for indirect light", "leave out 'only', or 'compensate'");
  }
  if (settings.method.name != "auto")
    methods::find_method(settings.method.name).make(settings.method.parameters);
}

}  // namespace lumirank
