#include "scenedesc/schema/frame_files.h"

#include <algorithm>
#include <charconv>
#include <filesystem>

namespace lumirank::scenedesc {

namespace fs = std::filesystem;

std::map<int, std::string> files_of_frames(const std::string& path) {
  std::error_code error;
  const std::string name = fs::path(path).filename().string();
  const std::size_t end = name.find_last_of('#') + 1;
  if (end == 0 || fs::exists(path, error)) return {};
  std::size_t begin = end;
  while (begin > 0 && name[begin - 1] == '#') --begin;
  const std::string head = name.substr(0, begin), tail = name.substr(end);
  std::map<int, std::string> found;
  for (const auto& entry : fs::directory_iterator(fs::path(path).parent_path(), error)) {
    const std::string other = entry.path().filename().string();
    if (other.size() < head.size() + tail.size() + (end - begin) || !other.starts_with(head) ||
        !other.ends_with(tail))
      continue;
    const char *from = other.data() + head.size(), *to = other.data() + other.size() - tail.size();
    int number = 0;
    const auto [stop, status] = std::from_chars(from, to, number);
    if (status == std::errc{} && stop == to && number >= 0) found.emplace(number, entry.path().string());
  }
  return found;
}

std::optional<FrameFile> file_of_frame(const std::string& path, std::optional<int> frame) {
  const std::map<int, std::string> found = files_of_frames(path);
  if (found.empty()) return std::nullopt;
  auto chosen = found.begin();
  if (frame) {
    chosen = found.lower_bound(*frame);
    // Between two that there are, the nearer one; the earlier of two as near.
    if (chosen == found.end() ||
        (chosen != found.begin() && chosen->first - *frame >= *frame - std::prev(chosen)->first))
      --chosen;
  }
  return FrameFile{chosen->second, found.begin()->first, found.rbegin()->first};
}

}  // namespace lumirank::scenedesc
