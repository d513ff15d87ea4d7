#include "api/shot_tensor.h"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <string_view>
#include <utility>

#include "api/render_tensor.h"
#include "api/shot_chunks.h"
#include "base/timer.h"
#include "image/atomic_file.h"

namespace lumirank::api {
namespace {

using Json = nlohmann::ordered_json;

// Frames of a chunk: as many as are asked for, and fit into the memory that is given.
int frames_at_once(const Shot& shot) {
  const ShotRange& range = shot.range;
  std::vector<Scene> first;
  for (int frame = range.first_key; frame <= std::min(range.last_key, range.first_key + 2); ++frame)
    first.push_back(shot.at(frame));
  return frames_within_memory(first, shot.settings.render, *shot.settings.tensor);
}

// All tails that `wanted` frames of a chunk need are there.
bool has_tails(const Shot& shot, const ShotChunks& chunks, const std::vector<int>& wanted) {
  return std::all_of(wanted.begin(), wanted.end(), [&](int frame) {
    return chunks.part(frame) == 1 || TailPicture(shot.folder.name(), frame).exists();
  });
}

void write_clusters(const ShotFolder& folder, const Chunk& chunk, const TensorFrames& made) {
  Json rectangles = Json::array();
  for (const auto& r : made.rectangles)
    rectangles.push_back(
        {{"frames", {chunk.first + static_cast<int>(r.begin), chunk.first + static_cast<int>(r.end) - 1}},
         {"lights", r.lights}});
  const Json clusters{{"frames", {chunk.first, chunk.tail_last}},
                      {"lights", made.lights},
                      {"rectangles", std::move(rectangles)}};
  image::write_whole_file(folder.numbered_file("clusters", chunk.first, ".json"), clusters.dump() + "\n");
}

// A chunk and its tail by one clustering; writes those of its own frames that are wanted. The tail of the
// one before it is there. False if it was interrupted.
bool render_chunk(const Shot& shot, const ShotChunks& chunks, const Chunk& chunk,
                  const std::vector<int>& wanted, const Sinks& sinks) {
  const ShotFolder& folder = shot.folder;
  const TensorSettings& tensor = *shot.settings.tensor;
  const Timer timer;
  std::vector<Scene> scenes;
  for (int frame = chunk.first; frame <= chunk.tail_last; ++frame)
    scenes.push_back(shot.at(frame, frame == chunk.first ? sinks : Sinks{}));
  const double read_seconds = timer.seconds() / chunk.size();
  TensorFrames made = render_tensor(scenes, shot.settings.render, tensor, sinks);
  std::vector<RenderResult>& results = made.frames;
  if (results.empty()) return false;
  if (tensor.write_clusters) write_clusters(folder, chunk, made);
  for (int frame = chunk.last + 1; frame <= chunk.tail_last; ++frame)
    if (!folder.is_finished(frame))
      TailPicture(folder.name(), frame).write(results[static_cast<std::size_t>(frame - chunk.first)].picture);
  for (const int frame : wanted) {
    RenderResult& result = results[static_cast<std::size_t>(frame - chunk.first)];
    const double part = chunks.part(frame);
    const TailPicture tail(folder.name(), frame);
    if (part < 1) tail.blend_into(result.picture, part);
    result.report.numbers["chunk.part"] = part;
    result.report.seconds["read"] = read_seconds;
    folder.write(frame, result.picture, result.report);
    tail.remove();
  }
  return true;
}

// Tells how far a part of the shot is, of all that is missing.
Sinks part_of_progress(const Sinks& sinks, double begin, double share) {
  Sinks own = sinks;
  own.progress = [&sinks, begin, share](const char* stage, double fraction) {
    // Stages of a chunk, and the part of its time that they take, about.
    constexpr std::pair<std::string_view, std::pair<double, double>> kStages[] = {
        {"frames", {0, 0.3}}, {"rows", {0.3, 0.15}}, {"columns", {0.45, 0.35}}, {"changes", {0.8, 0.2}}};
    for (const auto& [name, part] : kStages)
      if (name == stage) sinks.report("frames", begin + share * (part.first + part.second * fraction));
  };
  return own;
}

}  // namespace

void render_chunks(const Shot& shot, const std::vector<int>& missing, AnimationResult& result,
                   const Sinks& sinks) {
  if (missing.empty()) return;
  const ShotRange& range = shot.range;
  const ShotChunks chunks(range.first_key, std::max(range.last_key, range.last), frames_at_once(shot),
                          shot.settings.tensor->overlap);
  const auto all = static_cast<double>(missing.size());
  for (std::size_t k = 0; k < missing.size();) {
    const Chunk chunk = chunks.of(missing[k]);
    const double begin = static_cast<double>(k) / all;
    std::vector<int> wanted;
    while (k < missing.size() && missing[k] <= chunk.last) wanted.push_back(missing[k++]);
    const double share = static_cast<double>(wanted.size()) / all;
    const bool before = !has_tails(shot, chunks, wanted);
    if (sinks.cancelled() ||
        (before &&
         !render_chunk(shot, chunks, chunks.before(chunk), {}, part_of_progress(sinks, begin, share / 2))) ||
        !render_chunk(
            shot, chunks, chunk, wanted,
            part_of_progress(sinks, begin + (before ? share / 2 : 0), before ? share / 2 : share))) {
      result.interrupted = true;
      return;
    }
    result.rendered += static_cast<int>(wanted.size());
  }
}

}  // namespace lumirank::api
