#include "scenedesc/gltf/json.h"

#include <algorithm>
#include <iterator>
#include <nlohmann/json.hpp>

#include "base/error.h"

namespace lumirank::scenedesc::gltf {
namespace {

struct Progress {
  int line = 1;
  char last = ' ';  // the character that was read last
};

// Walks over the text and counts its lines.
class Cursor {
 public:
  using iterator_category = std::input_iterator_tag;
  using value_type = char;
  using difference_type = std::ptrdiff_t;
  using pointer = const char*;
  using reference = const char&;

  Cursor(const char* at, Progress* progress) : at_(at), progress_(progress) {}
  reference operator*() const { return *at_; }
  Cursor& operator++() {
    progress_->last = *at_;
    if (*at_ == '\n') ++progress_->line;
    ++at_;
    return *this;
  }
  Cursor operator++(int) {
    const Cursor before = *this;
    ++*this;
    return before;
  }
  friend bool operator==(const Cursor& a, const Cursor& b) { return a.at_ == b.at_; }

 private:
  const char* at_;
  Progress* progress_;
};

class Builder : public nlohmann::json_sax<nlohmann::json> {
 public:
  Builder(const Progress& progress, const std::string& filename) : progress_(progress), filename_(filename) {}

  bool null() override { return add(Json::Kind::null), true; }
  bool boolean(bool value) override { return add(Json::Kind::boolean).number = value ? 1 : 0, true; }
  bool number_integer(number_integer_t value) override {
    return add_number(static_cast<double>(value), true);
  }
  bool number_unsigned(number_unsigned_t value) override {
    return add_number(static_cast<double>(value), true);
  }
  bool number_float(number_float_t value, const string_t&) override { return add_number(value, false); }
  bool string(string_t& value) override { return add(Json::Kind::text).text = std::move(value), true; }
  bool binary(binary_t&) override { return false; }
  bool start_object(std::size_t) override { return open(Json::Kind::object); }
  bool start_array(std::size_t) override { return open(Json::Kind::list); }
  bool end_object() override { return open_.pop_back(), true; }
  bool end_array() override { return open_.pop_back(), true; }
  bool key(string_t& value) override {
    auto& keys = open_.back()->keys;
    // Objects have few keys, or are names that this reader does not read.
    if (keys.size() < 1000 && std::find(keys.begin(), keys.end(), value) != keys.end())
      fail("the key \"" + value + "\" is given twice", "keep one of them");
    keys.push_back(std::move(value));
    return true;
  }
  bool parse_error(std::size_t, const std::string&, const nlohmann::json::exception& error) override {
    // "[json.exception.parse_error.101] parse error at line 1, column 2: what is wrong"
    std::string what = error.what();
    if (const auto column = what.find("column "); column != std::string::npos) {
      if (const auto colon = what.find(": ", column); colon != std::string::npos)
        what = what.substr(colon + 2);
    } else if (const auto bracket = what.find("] "); bracket != std::string::npos) {
      what = what.substr(bracket + 2);
    }
    // What was expected instead would be a list of the grammar.
    if (const auto semicolon = what.find("; expected"); semicolon != std::string::npos)
      what.resize(semicolon);
    fail("not valid JSON: " + what, "repair the file, or export it again");
  }

  Json take() { return std::move(root_); }

 private:
  [[noreturn]] void fail(const std::string& message, const std::string& remedy) const {
    throw InputError({filename_, line()}, message, remedy);
  }
  // A number's end is known by the character after it.
  int line() const { return progress_.line - (progress_.last == '\n' ? 1 : 0); }

  Json& add(Json::Kind kind) {
    Json* made = &root_;
    if (!open_.empty()) made = &open_.back()->items.emplace_back();
    made->kind = kind;
    made->line = line();
    return *made;
  }
  bool add_number(double value, bool integral) {
    Json& made = add(Json::Kind::number);
    made.number = value;
    made.integral = integral;
    return true;
  }
  bool open(Json::Kind kind) {
    if (open_.size() >= 100) fail("the JSON is nested more than 100 deep", "no glTF file needs that");
    open_.push_back(&add(kind));
    return true;
  }

  const Progress& progress_;
  const std::string& filename_;
  Json root_;
  std::vector<Json*> open_;  // a list grows only while it is the innermost, so these stay where they are
};

}  // namespace

const Json* Json::find(std::string_view key) const {
  for (std::size_t k = 0; k < keys.size(); ++k)
    if (keys[k] == key) return &items[k];
  return nullptr;
}

Json parse_json(std::string_view text, const std::string& filename) {
  Progress progress;
  Builder builder(progress, filename);
  nlohmann::json::sax_parse(Cursor(text.data(), &progress), Cursor(text.data() + text.size(), &progress),
                            &builder);
  return builder.take();
}

}  // namespace lumirank::scenedesc::gltf
