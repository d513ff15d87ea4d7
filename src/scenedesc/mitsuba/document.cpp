// From bytes to the tree of elements: pugixml parses, this file adds lines, parameters, includes and limits.
#include <algorithm>
#include <charconv>
#include <cstdint>
#include <pugixml.hpp>
#include <set>

#include "scenedesc/mitsuba/element.h"
#include "scenedesc/schema/files.h"

namespace lumirank::scenedesc::mitsuba {

namespace {

constexpr int kDeepest = 64;            // of nested elements; real scenes use about 10
constexpr std::size_t kIncludes = 32;   // of files inside files
constexpr std::size_t kFiles = 10'000;  // included in all
constexpr std::size_t kElements = 5'000'000;
constexpr std::size_t kSubstituted =
    64u << 20;  // bytes put in for $parameters in all: defaults can double each other

// Offsets of line starts, to turn pugixml's byte offsets into lines.
class Lines {
 public:
  explicit Lines(const std::string& text) {
    for (std::size_t i = 0; i < text.size(); ++i)
      if (text[i] == '\n') ends_.push_back(i);
  }
  int at(std::ptrdiff_t offset) const {
    if (offset < 0) return 0;
    const auto it = std::lower_bound(ends_.begin(), ends_.end(), static_cast<std::size_t>(offset));
    return static_cast<int>(it - ends_.begin()) + 1;
  }

 private:
  std::vector<std::size_t> ends_;
};

class Loader {
 public:
  explicit Loader(const std::map<std::string, std::string>& defines)
      : defines_(defines), parameters_(defines) {}

  Document load(const std::string& text, const std::string& filename) {
    document_.root = std::make_unique<Element>();
    open_.push_back(resolve_path(filename, ""));
    read_into(*document_.root, text, filename, true, 0);
    for (const auto& [name, value] : defines_)
      if (!used_.count(name))
        document_.notes.emplace_back(SourceLocation{filename, 0},
                                     "the parameter \"" + name + "\" (nothing uses it)");
    return std::move(document_);
  }

 private:
  // Adds the children of the file's root to `into`; for the main file also the root's own data.
  void read_into(Element& into, const std::string& text, const std::string& filename, bool main, int depth) {
    const Lines lines(text);
    pugi::xml_document xml;
    const unsigned flags = pugi::parse_default | pugi::parse_doctype;
    const pugi::xml_parse_result result =
        xml.load_buffer(text.data(), text.size(), flags, pugi::encoding_auto);
    if (text.find_first_not_of(" \t\r\n") == std::string::npos)
      throw InputError({filename, 1}, "the file is empty",
                       "a Mitsuba scene starts with <scene version=\"…\">");
    for (pugi::xml_node node : xml.children())
      if (node.type() == pugi::node_doctype)
        throw InputError({filename, lines.at(node.offset_debug())},
                         "the file declares a DOCTYPE, which is not accepted",
                         "remove it; entities are not expanded");
    if (result.status == pugi::status_no_document_element)
      throw InputError({filename, 1}, "this is not well-formed XML: it holds no element",
                       "is this a Mitsuba scene?");
    if (!result)
      throw InputError({filename, lines.at(result.offset)},
                       std::string("this is not well-formed XML: ") + result.description(),
                       "check whether the file is complete and is a Mitsuba scene");
    const pugi::xml_node root = xml.document_element();
    const SourceLocation where{filename, lines.at(root.offset_debug())};
    if (std::string(root.name()) != "scene")
      throw InputError(where, std::string("the root element is <") + root.name() + ">, not <scene>",
                       "is this a Mitsuba scene?");
    for (pugi::xml_node more = root.next_sibling(); more; more = more.next_sibling())
      if (more.type() == pugi::node_element)
        throw InputError({filename, lines.at(more.offset_debug())},
                         "a second root element <" + std::string(more.name()) + ">",
                         "put everything into one <scene>");
    read_version(root, where, main);
    if (main) {
      into.tag = "scene";
      into.where = where;
    }
    convert_children(into, root, filename, lines, depth + 1);
  }

  void read_version(pugi::xml_node root, const SourceLocation& where, bool main) {
    const pugi::xml_attribute attribute = root.attribute("version");
    if (!attribute) {
      if (main)
        throw InputError(where, "<scene> has no version",
                         "write <scene version=\"3.0.0\"> (or 0.6.0 for toWorld, intIOR, …)");
      return;  // an included file follows the one that includes it
    }
    const std::string text = attribute.value();
    int part[3] = {0, 0, 0};
    const char *p = text.data(), *end = p + text.size();
    bool good = !text.empty();
    for (int i = 0; i < 3 && good && p < end; ++i) {
      const auto [next, error] = std::from_chars(p, end, part[i]);
      good = error == std::errc() && part[i] >= 0 && (next == end || (*next == '.' && i < 2));
      p = next == end ? end : next + 1;
    }
    const Dialect dialect{part[0], part[1], part[2]};
    const bool known = (dialect.major == 0 && dialect.minor >= 5 && dialect.minor <= 6) ||
                       dialect.major == 2 || dialect.major == 3;
    if (!good || p != end)
      throw InputError(where, "version \"" + text + "\" is not a version number",
                       "write 0.6.0 or 3.0.0, say");
    if (!known)
      throw InputError(where, "version " + text + " of the Mitsuba format is not known",
                       "0.5, 0.6, 2.x and 3.x are; Mitsuba can upgrade older ones");
    if (main)
      document_.dialect = dialect;
    else if (dialect.camel_case() != document_.dialect.camel_case())
      throw InputError(
          where, "an included file of version " + text + " in a scene of version " + document_.dialect.text(),
          "give both the same version");
  }

  void convert_children(Element& into, pugi::xml_node from, const std::string& filename, const Lines& lines,
                        int depth) {
    for (pugi::xml_node node : from.children()) {
      const SourceLocation where{filename, lines.at(node.offset_debug())};
      if (node.type() == pugi::node_pcdata || node.type() == pugi::node_cdata) {
        const std::string stray = node.value();
        const auto first = std::min(stray.find_first_not_of(" \t\r\n"), stray.size());
        const auto end = std::min(stray.find_first_of("\r\n", first), stray.size());
        throw InputError({filename, lines.at(node.offset_debug() + static_cast<std::ptrdiff_t>(first))},
                         "stray text \"" + stray.substr(first, std::min<std::size_t>(end - first, 40)) +
                             "\" between elements",
                         "values are written as value=\"…\"");
      }
      if (node.type() != pugi::node_element) continue;
      if (depth > kDeepest)
        throw InputError(where, "elements are nested more than 64 deep", "flatten the scene");
      if (++elements_ > kElements) throw InputError(where, "the scene has more than 5 million elements");
      const std::string tag = node.name();
      auto element = std::make_unique<Element>();
      element->tag = tag;
      element->where = where;
      std::set<std::string> seen;
      for (pugi::xml_attribute attribute : node.attributes()) {
        if (!seen.insert(attribute.name()).second)
          throw InputError(where, "<" + tag + "> has the attribute \"" + attribute.name() + "\" twice",
                           "remove one");
        element->attributes.emplace_back(attribute.name(), substitute(attribute.value(), where));
      }
      if (tag == "default") {
        const std::string& name = element->require("name");
        // A parameter that the caller defined wins, and so does the first default of a name.
        parameters_.emplace(name, element->require("value"));
      } else if (tag == "include") {
        include(into, *element, depth);
      } else {
        convert_children(*element, node, filename, lines, depth + 1);
        into.children.push_back(std::move(element));
      }
    }
  }

  void include(Element& into, const Element& element, int depth) {
    const std::string filename = resolve_path(element.require("filename"), element.where.file);
    std::string chain;
    for (const std::string& file : open_) chain += file + " → ";
    if (std::find(open_.begin(), open_.end(), filename) != open_.end())
      throw InputError(element.where, "files include each other in a loop: " + chain + filename,
                       "remove one <include>");
    if (open_.size() > kIncludes)
      throw InputError(element.where, "includes are nested more than 32 deep: " + chain + filename);
    if (++files_ > kFiles) throw InputError(element.where, "more than 10,000 files are included");
    const std::string text = read_file(filename, element.where, kMaxText);
    open_.push_back(filename);
    read_into(into, text, filename, false, depth);
    open_.pop_back();
  }

  // $name or ${name}; the longest known name wins when one is the start of another, as in Mitsuba.
  std::string substitute(const std::string& text, const SourceLocation& where) {
    std::string out;
    for (std::size_t i = 0; i < text.size();) {
      if (text[i] != '$') {
        out += text[i++];
        continue;
      }
      const bool braces = i + 1 < text.size() && text[i + 1] == '{';
      const std::size_t start = i + (braces ? 2 : 1);
      std::size_t end = start;
      while (end < text.size() && (std::isalnum(static_cast<unsigned char>(text[end])) || text[end] == '_'))
        ++end;
      std::string name = text.substr(start, end - start);
      while (!braces && !name.empty() && !parameters_.count(name)) name.pop_back();
      const auto found = parameters_.find(name);
      if (found == parameters_.end() || (braces && (end >= text.size() || text[end] != '}')))
        throw InputError(
            where, "the parameter \"" + text.substr(i, end - i) + "\" is not defined",
            "known are: " + known_parameters() + "; add <default name=\"…\" value=\"…\"/> or --define");
      used_.insert(name);
      out += found->second;
      substituted_ += found->second.size();
      if (substituted_ > kSubstituted)
        throw InputError(where, "the $parameters put in add up to more than 64 MiB");
      i = start + name.size() + (braces ? 1 : 0);
    }
    return out;
  }

  std::string known_parameters() const {
    std::string names;
    for (const auto& [name, value] : parameters_) names += (names.empty() ? "$" : ", $") + name;
    return names.empty() ? "none" : names;
  }

  const std::map<std::string, std::string>& defines_;
  std::map<std::string, std::string> parameters_;
  std::set<std::string> used_;
  std::vector<std::string> open_;  // the chain of files being read
  std::size_t elements_ = 0, files_ = 0, substituted_ = 0;
  Document document_;
};

}  // namespace

Document load_document(const std::string& text, const std::string& filename,
                       const std::map<std::string, std::string>& defines) {
  return Loader(defines).load(text, filename);
}

}  // namespace lumirank::scenedesc::mitsuba
