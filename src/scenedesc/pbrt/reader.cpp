#include "scenedesc/pbrt/reader.h"

#include <algorithm>
#include <cctype>
#include <filesystem>

#include "scenedesc/pbrt/read_pbrt.h"
#include "scenedesc/pbrt/version3.h"
#include "scenedesc/schema/expansion.h"
#include "scenedesc/schema/files.h"

namespace lumirank::scenedesc::pbrt {

namespace {

constexpr std::size_t kIncludes = 32;    // files in files
constexpr std::size_t kFiles = 100'000;  // in all
constexpr std::size_t kNested = 1'000;   // attribute blocks in each other
constexpr std::size_t kInherited = 256;  // parameters by Attribute

const char* const kOptions[] = {
    "disablepixeljitter", "disabletexturefiltering", "disablewavelengthjitter", "displacementedgescale",
    "forcediffuse",       "msereferenceimage",       "msereferenceout",         "pixelstats",
    "wavefront"};

// pbrt takes option names in any case, with hyphens and underscores or without.
std::string plain_option(const std::string& name) {
  std::string out;
  for (const char c : name)
    if (c != '-' && c != '_') out += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return out;
}

}  // namespace

Reader::Reader(const std::string& filename, const ReadOptions& options)
    : SceneReader(filename, "pbrt-v4", options), main_file_(filename) {
  film_.width = 1280, film_.height = 720;
}

std::string Reader::resolve(const std::string& name, const Place& where) const {
  for (const std::string& file : {main_file_, where.file ? *where.file : main_file_}) {
    std::string path = resolve_path(name, file);
    if (std::error_code error; !name.empty() && std::filesystem::exists(path, error)) return path;
  }
  return {};
}

std::string Reader::existing_file(const std::string& name, const Place& where, const std::string& kind) {
  const std::string path = resolve(name, where);
  if (path.empty())
    throw InputError(where, kind + " not found: " + resolve_path(name, main_file_), "check the name");
  return named_file(path, where, kind, "").name;
}

Reader::NamedFile Reader::file(const std::string& name, const Place& where, const std::string& kind,
                               const std::string& stand_in) {
  if (!resolve(name, where).empty()) return {existing_file(name, where, kind), false};
  const std::string path = resolve_path(name, main_file_);
  missing_file(where, kind + " not found: " + path, stand_in);
  return {path, true};
}

std::string Reader::file_text(const std::string& path, const Place& where) const {
  return read_file(path, where, kMaxPbrtText);
}

std::string Reader::take_text(Tokens& tokens, const Token& word, const char* what) {
  if (tokens.peek().kind != Token::Kind::text)
    throw InputError(tokens.place(word), std::string(word.value) + " has no " + what,
                     std::string("write it in quotes after ") + std::string(word.value));
  return std::string(tokens.take().value);
}

Params Reader::take_params(Tokens& tokens, const Token& word, const std::string& type, const char* defaults) {
  const auto found = defaults ? state_.defaults.find(defaults) : state_.defaults.end();
  return {*this, std::string(word.value) + (type.empty() ? "" : " " + in_quotes(type)), tokens.place(word),
          parse_parameters(tokens, version3_),
          found == state_.defaults.end() ? nullptr : found->second.get()};
}

std::vector<double> Reader::take_numbers(Tokens& tokens, const Token& word, std::size_t count) {
  std::vector<double> out;
  const bool list = tokens.peek().kind == Token::Kind::open;
  if (list) tokens.take();
  while (tokens.peek().kind == Token::Kind::word && (list || out.size() < count)) {
    // The next directive: numbers are missing.
    if (const char first = tokens.peek().value[0]; first >= 'A' && first <= 'Z') break;
    const Token token = tokens.take();
    out.push_back(parse_number(token.value, tokens.place(token)));
  }
  if (list && tokens.take().kind != Token::Kind::close)
    throw InputError(tokens.place(word), "the list of " + std::string(word.value) + " has no end",
                     "close it with a ]");
  if (out.size() != count)
    throw InputError(tokens.place(word), std::string(word.value) + " has " + std::to_string(out.size()) +
                                             " numbers; " + std::to_string(count) + " are needed");
  return out;
}

void Reader::push(const char* by, const Place& where) {
  if (saved_.size() >= kNested)
    throw InputError(where, "blocks are nested more than 1,000 deep", "is an AttributeEnd missing?");
  saved_.push_back({state_, by, where});
}

void Reader::pop(const char* by, const char* end, const Place& where) {
  if (saved_.empty())
    throw InputError(where, std::string(end) + " without " + by, "remove it, or add the beginning");
  if (std::string_view(saved_.back().by) != by)
    throw InputError(
        where,
        std::string(end) + " ends what " + saved_.back().by + " began at " + to_string(saved_.back().where),
        "close the blocks in turn");
  state_ = std::move(saved_.back().state);
  saved_.pop_back();
}

void Reader::require_world(const Token& word, const Place& where, bool in_world) const {
  if (in_world == in_world_) return;
  throw InputError(where, std::string(word.value) + (in_world ? " before WorldBegin" : " after WorldBegin"),
                   in_world ? "the scene itself comes after it" : "camera, film and the like come before it");
}

void Reader::include(Tokens& tokens, const Token& word, bool import) {
  const Place where = tokens.place(word);
  const std::string name = take_text(tokens, word, "file name");
  const std::string path = existing_file(name, where, "included file");
  std::string chain;
  for (const std::string& file : open_files_) chain += file + " → ";
  if (std::find(open_files_.begin(), open_files_.end(), path) != open_files_.end())
    throw InputError(where, "files include each other in a loop: " + chain + path, "remove one of the lines");
  if (open_files_.size() > kIncludes)
    throw InputError(where, "includes are nested more than 32 deep: " + chain + path);
  if (++files_ > kFiles) throw InputError(where, "more than 100,000 files are included");
  if (import) {
    require_world(word, where, true);
    push("Import", where);
  }
  File& file = sources_.emplace_back(File{path, file_text(path, where)});
  open_files_.push_back(path);
  run(file);
  file.text = {};
  open_files_.pop_back();
  if (import) pop("Import", "the end of the imported file", where);
}

void Reader::inherit(Tokens& tokens, const Token& word) {
  const Place where = tokens.place(word);
  const std::string target = take_text(tokens, word, "target");
  constexpr std::string_view kTargets[] = {"shape", "light", "material", "medium", "texture"};
  if (std::find(std::begin(kTargets), std::end(kTargets), target) == std::end(kTargets))
    throw InputError(where, "Attribute has the target " + in_quotes(target),
                     "shape, light, material, medium and texture are known");
  auto& slot = state_.defaults[target];
  // Copied only if a saved state shares it.
  using List = std::vector<Parameter>;
  const auto all = slot.use_count() == 1 ? std::const_pointer_cast<List>(slot)
                   : slot                ? std::make_shared<List>(*slot)
                                         : std::make_shared<List>();
  for (Parameter& p : parse_parameters(tokens, version3_)) {
    std::erase_if(*all, [&](const Parameter& old) { return old.name == p.name; });
    all->push_back(std::move(p));
  }
  if (all->size() > kInherited)
    throw InputError(where, "Attribute directives set more than 256 parameters of one kind");
  slot = all;
}

bool Reader::option_directive(Tokens& tokens, const Token& word) {
  const std::string_view name = word.value;
  const Place where = tokens.place(word);
  using Read = void (Reader::*)(Params&, const std::string&);
  constexpr std::pair<std::string_view, Read> kReads[] = {{"Camera", &Reader::read_camera},
                                                          {"Film", &Reader::read_film},
                                                          {"PixelFilter", &Reader::read_filter},
                                                          {"Sampler", &Reader::read_sampler},
                                                          {"Integrator", &Reader::read_integrator}};
  for (const auto& [known, read] : kReads)
    if (known == name) {
      require_world(word, where, false);
      const std::string type = take_text(tokens, word, "type");
      Params p = take_params(tokens, word, type, nullptr);
      (this->*read)(p, type);
      p.finish();
      return true;
    }
  if (name == "Accelerator") {  // how pbrt finds its triangles
    require_world(word, where, false);
    const std::string type = take_text(tokens, word, "type");
    take_params(tokens, word, type, nullptr);
  } else if (name == "Option") {
    // A name and one value, not a list of parameters.
    const std::string option = take_text(tokens, word, "name");
    const Token value = tokens.take();
    const bool directive = value.kind == Token::Kind::word && value.value[0] >= 'A' && value.value[0] <= 'Z';
    if (directive || (value.kind != Token::Kind::word && value.kind != Token::Kind::text))
      throw InputError(where, "the option " + in_quotes(option) + " has no value",
                       "write Option \"seed\" 3, say");
    const std::string plain = plain_option(option);
    if (std::find(std::begin(kOptions), std::end(kOptions), plain) != std::end(kOptions)) {
      if (value.value != "false") warn(where, "the option " + in_quotes(option), "");
    } else if (plain != "rendercoordsys" && plain != "seed") {  // where pbrt computes, and with which numbers
      warn(where, "an option of the name " + in_quotes(option), "");
    }
  } else if (name == "ColorSpace") {
    const std::string text = take_text(tokens, word, "name");
    const auto space = color_space(text);
    if (!space)
      throw InputError(where, "the color space " + in_quotes(text) + " is not known",
                       "srgb, dci-p3, rec2020 and aces2065-1 are");
    state_.space = *space;
  } else {
    return false;
  }
  return true;
}

void Reader::directive(Tokens& tokens, const Token& word) {
  if (word.value == "Include") return include(tokens, word, false);
  if (word.value == "Import") return include(tokens, word, true);
  if (transform_directive(tokens, word) || block_directive(tokens, word) || object_directive(tokens, word) ||
      state_directive(tokens, word) || option_directive(tokens, word))
    return;
  throw InputError(tokens.place(word), in_quotes(word.value) + " is not a directive of " + scene_.format,
                   "check its spelling");
}

void Reader::run(const File& file) {
  Tokens tokens(file);
  while (tokens.peek().kind != Token::Kind::end && !ended_) {
    const Token word = tokens.take();
    if (word.kind == Token::Kind::word) {
      directive(tokens, word);
      continue;
    }
    const std::string what = word.kind == Token::Kind::text   ? "the string " + in_quotes(word.value)
                             : word.kind == Token::Kind::open ? "a ["
                                                              : "a ]";
    throw InputError(tokens.place(word), what + " where a directive should be",
                     "a directive such as Shape or Translate comes first");
  }
}

void Reader::finish() {
  if (!in_world_)
    throw InputError({main_file_, 1}, "the scene has no WorldBegin",
                     "is this a complete scene? Shapes and lights come after WorldBegin");
  if (!saved_.empty())
    throw InputError(saved_.back().where, std::string(saved_.back().by) + " without its end",
                     "close the block; is the file complete?");
  for (const auto& [name, material] : materials_)
    if (!material.defined)
      throw InputError(material.first_use, "the material " + in_quotes(name) + " is not defined",
                       "define it with MakeNamedMaterial");
  check_mixtures();
  resolve_media();
  for (const auto& [index, name] : pending_instances_) {
    ShapeDesc& shape = scene_.shapes[static_cast<std::size_t>(index)];
    const auto found = objects_.find(name);
    if (found == objects_.end())
      throw InputError(shape.where, "the object " + in_quotes(name) + " is not defined",
                       "define it with ObjectBegin");
    std::get<InstanceDesc>(shape.kind).group = found->second;
  }
  check_expansion(scene_);
  for (const auto& [name, value] : options_.defines)
    warn({main_file_, 0}, "the parameter \"" + name + "\" (pbrt scenes have none)", "");
}

SceneDesc Reader::read(std::string text) {
  version3_ = is_version3(text);
  if (version3_) scene_.format = "pbrt-v3";
  open_files_.push_back(resolve_path(main_file_, ""));
  run(sources_.emplace_back(File{main_file_, std::move(text)}));
  finish();
  return std::move(scene_);
}

}  // namespace lumirank::scenedesc::pbrt

namespace lumirank::scenedesc {

SceneDesc parse_pbrt(const std::string& text, const std::string& filename, const ReadOptions& options) {
  return pbrt::Reader(filename, options).read(text);
}

SceneDesc read_pbrt(const std::string& filename, const ReadOptions& options) {
  return parse_pbrt(read_file(filename, SourceLocation{}, kMaxPbrtText), filename, options);
}

}  // namespace lumirank::scenedesc
