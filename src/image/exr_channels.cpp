#include "image/exr_channels.h"

#include <algorithm>
#include <cctype>
#include <tuple>

namespace lumirank::image {
namespace {

struct ExrChannelName {
  std::string whole, layer, last;  // "direct.R" is R of the layer "direct"
  std::size_t rank = 0;            // within its layer
};

std::string lower_case(std::string text) {
  for (char& c : text) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return text;
}

bool is_exr_alpha(const ExrChannelName& name) {
  const std::string last = lower_case(name.last);
  return last == "a" || last == "alpha";
}

// Colors before luminance before alpha before depth; what has none of these names comes last. A layer of
// positions or normals goes x, y, z.
std::size_t exr_rank(const std::string& last, bool coordinates) {
  static const std::vector<std::string> kColors{"r",    "red",  "g",  "green", "b",     "blue", "y",
                                                "real", "imag", "a",  "alpha", "ar",    "ra",   "ag",
                                                "ga",   "ab",   "ba", "z",     "depth", "zback"};
  static const std::vector<std::string> kCoordinates{"r",  "red", "g",    "green", "b",  "blue",  "x",
                                                     "y",  "z",   "real", "imag",  "a",  "alpha", "ar",
                                                     "ra", "ag",  "ga",   "ab",    "ba", "depth", "zback"};
  const auto& order = coordinates ? kCoordinates : kColors;
  return static_cast<std::size_t>(std::find(order.begin(), order.end(), lower_case(last)) - order.begin());
}

void sort_exr_channels(std::vector<ExrChannelName>& names) {
  for (ExrChannelName& name : names) {
    const auto has = [&](const char* wanted) {
      return std::any_of(names.begin(), names.end(), [&](const ExrChannelName& other) {
        return other.layer == name.layer && lower_case(other.last) == wanted;
      });
    };
    name.rank = exr_rank(name.last, has("x") && (has("y") || has("z")));
  }
  std::sort(names.begin(), names.end(), [](const ExrChannelName& a, const ExrChannelName& b) {
    return std::tie(a.layer, a.rank, a.last) < std::tie(b.layer, b.rank, b.last);
  });
}

}  // namespace

ExrChannels choose_exr_channels(const std::vector<std::string>& names) {
  std::vector<ExrChannelName> sorted;
  for (const std::string& name : names) {
    const std::size_t dot = name.rfind('.');
    const bool layered = dot != std::string::npos;
    sorted.push_back({name, layered ? name.substr(0, dot) : "", layered ? name.substr(dot + 1) : name});
  }
  sort_exr_channels(sorted);

  ExrChannels chosen;
  const auto alpha = std::find_if(sorted.begin(), sorted.end(), is_exr_alpha);
  if (alpha != sorted.end()) chosen.alpha = alpha->whole;
  const auto has = [&](const char* name) {
    return std::find(names.begin(), names.end(), name) != names.end();
  };
  if (has("R") && has("G") && has("B")) {
    chosen.color = {"R", "G", "B"};
    return chosen;
  }
  std::vector<std::string> others;
  for (const ExrChannelName& name : sorted)
    if (name.whole != chosen.alpha) others.push_back(name.whole);
  if (others.empty()) others.push_back(chosen.alpha);  // a file of nothing but alpha is read as gray
  const std::size_t step = others.size() >= 3 ? 1 : 0;
  for (std::size_t c = 0; c < 3; ++c) chosen.color[c] = others[c * step];
  return chosen;
}

}  // namespace lumirank::image
