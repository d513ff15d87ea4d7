#include "scenedesc/pbrt/tokens.h"

namespace lumirank::scenedesc::pbrt {

namespace {

bool is_space(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\n' || c == '\f' || c == '\v'; }
bool ends_word(char c) { return is_space(c) || c == '"' || c == '[' || c == ']' || c == '#'; }

}  // namespace

std::string in_quotes(std::string_view text) {
  std::string out = "\"";
  for (const char c : text.substr(0, 40)) out += static_cast<unsigned char>(c) < ' ' ? '?' : c;
  return out + (text.size() > 40 ? "…\"" : "\"");
}

Tokens::Tokens(const File& file) : file_(file) {
  if (file.text.rfind("\xef\xbb\xbf", 0) == 0) at_ = 3;  // a byte order mark
  next_ = read();
}

Token Tokens::take() {
  const Token token = next_;
  if (token.kind != Token::Kind::end) next_ = read();
  return token;
}

Token Tokens::read() {
  const std::string& text = file_.text;
  while (at_ < text.size()) {
    const char c = text[at_];
    if (c == '\n') ++line_;
    if (is_space(c)) {
      ++at_;
    } else if (c == '#') {
      while (at_ < text.size() && text[at_] != '\n') ++at_;
    } else if (c == '[' || c == ']') {
      ++at_;
      return {c == '[' ? Token::Kind::open : Token::Kind::close, {}, line_};
    } else if (c == '"') {
      return read_text();
    } else {
      if (c == '\0')
        throw InputError({file_.name, line_}, "the file holds a zero byte", "pbrt scenes are text files");
      const std::size_t start = at_;
      while (at_ < text.size() && !ends_word(text[at_]) && text[at_] != '\0') ++at_;
      return {Token::Kind::word, std::string_view(text).substr(start, at_ - start), line_};
    }
  }
  return {Token::Kind::end, {}, line_};
}

Token Tokens::read_text() {
  const std::string& text = file_.text;
  const std::size_t start = ++at_;
  bool escaped = false;
  while (at_ < text.size() && text[at_] != '"' && text[at_] != '\n') {
    if (text[at_] == '\\' && at_ + 1 < text.size() && text[at_ + 1] != '\n') escaped = true, ++at_;
    ++at_;
  }
  if (at_ >= text.size() || text[at_] == '\n')
    throw InputError(
        {file_.name, line_},
        "the string " + in_quotes(std::string_view(text).substr(start, at_ - start)) + " has no end",
        "close it with a quote on the same line");
  const std::string_view raw = std::string_view(text).substr(start, at_++ - start);
  if (!escaped) return {Token::Kind::text, raw, line_};
  std::string& out = unescaped_.emplace_back();
  for (std::size_t i = 0; i < raw.size(); ++i) {
    if (raw[i] != '\\' || i + 1 >= raw.size()) {
      out += raw[i];
      continue;
    }
    switch (const char c = raw[++i]) {
      case 'n':
        out += '\n';
        break;
      case 't':
        out += '\t';
        break;
      case 'r':
        out += '\r';
        break;
      case '"':
      case '\'':
      case '\\':
        out += c;
        break;
      default:
        throw InputError({file_.name, line_}, std::string("the escape \\") + c + " is not known",
                         "write \\\\ for a backslash");
    }
  }
  return {Token::Kind::text, out, line_};
}

}  // namespace lumirank::scenedesc::pbrt
