// A scene that moves, as numbered pictures.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "lumirank/export.h"
#include "lumirank/lumirank.h"

namespace lumirank {

// Tensor clustering (Hašan et al. 2008): columns are used in many frames, so that a shot costs less than its
// frames by themselves, and does not flicker.
struct TensorSettings {
  int chunk = 40;  // frames that are clustered together, counted from the first one of the motion
  // Frames that a chunk has in common with the next one, where one is blended into the other (at most
  // `chunk`). A process that is given later frames alone makes the chunk before them as well, unless its tail
  // is there.
  int overlap = 4;
  double memory = 0;  // MB that the process may take at about; chunks are as short as it takes; 0: any
  int rows = 100;     // of each frame, read whole
  int columns = 200;  // for each frame, in the mean; 0: all, the sum that clusterings approach
  // Of lights, before they are split in lights or in time; at most a quarter of all.
  int initial_clusters = 1000;
  double time_weight = 1;  // a split in time is taken if it leaves less cost by this factor; 0: none
  // Whether a cluster's column is carried to its other frames, or computed in each. Automatic: carried,
  // unless clusters last for so few frames that it saves little, as where the camera moves among detail.
  enum class Carrying { automatic, always, never };
  Carrying carrying = Carrying::automatic;
  // Light of other frames is not carried to what is farther from all that they show than so many distances
  // between neighboring samples (of a picture with 256² receivers; in larger ones of as large a part of it):
  // it was hidden there, and is shaded afresh. 0: no bound, as in the paper.
  double max_distance = 10;
  // By how large a part of its light a place may differ from what is carried to it (a shadow or a highlight
  // that moves); else it and what is around it are shaded afresh. 0: no bound, as in the paper.
  double max_change = 0.05;
  // A cluster's lights are summed one by one where what stands for them is so large a part of the mean light,
  // and ten times as bright as at the places that were read, in the quadratic mean: it would be a spot there
  // (in what shines, and in corners). 0: nowhere, as in the paper.
  double max_peak = 0.02;
  // How often light is averaged with one frame on either side where it changes evenly, so that errors do not
  // flicker; no farther than `max_distance`, each time by no more than 1.2 of `max_change`, or 0.6 of
  // the error that is asked for. 0: not at all, as in the paper.
  int filter = 1;
  // The lights that stand for their clusters: those of the largest norm, as in the paper, or those nearest to
  // the cluster's mean, which are not biased towards lights close to the rows that are read.
  bool largest_representatives = false;
  int bits = 16;  // of the rows' entries in memory: 16 or 32
  // Each chunk's clusters are written too, as clusters_0000.json by its first frame: the chunk's "frames"
  // (first and last), the number of "lights", and "rectangles", each with its "frames" and "lights".
  bool write_clusters = false;
};

// As `--set` of `lumirank animate --method tensor-clustering` takes them: defaults but for what is given. One
// that there is not, or of a wrong value, is an InputError.
LUMIRANK_API TensorSettings tensor_settings(const std::map<std::string, std::string>& parameters);
// The other way, all of them; reports have them so.
LUMIRANK_API std::map<std::string, std::string> parameters_of(const TensorSettings& settings);

struct AnimateSettings {
  // Of every frame: with the same seed, so the same random numbers, in each, unless they are averaged.
  RenderSettings render;
  double frames_per_second = 24;
  // Frame k is the moment k / frames_per_second; -1: the first one and the last one of the motion.
  int first = -1, last = -1;
  std::vector<std::string> endings = {".exr", ".png"};  // of each frame's pictures
  DisplaySettings display;
  // Frames that are rendered one by one are averaged with so many before and as many after, place by place,
  // where light changes by no more than noise explains: what a denoiser leaves of noise boils otherwise.
  // Every frame has a seed of its own then: that of `render` and its number. 0, or not given: none. Not with
  // `tensor`, which has a filter of its own, or an open shutter.
  std::optional<int> temporal_filter = {};
  // Instead of the method of `render`, for columns.
  std::optional<TensorSettings> tensor = {};
  // For previews of large meshes that deform, frame by frame: where only vertices have moved since the frame
  // before, Embree's structure is refitted instead of built anew. That takes a tenth of the time, but rays
  // take longer the more a mesh has bent, and which of two surfaces in the same place is seen can depend on
  // where the shot was begun. Meshes of less than 65,536 triangles are built anew. Not with `tensor` or an
  // open shutter, which need the structures of many moments at once (InputError).
  bool refit = false;
};

inline constexpr int kShotFilter = 3;  // frames on either side

// What `lumirank animate` does where it is not told, if the scene moves. Where the method is "auto" and a
// still would be rendered in passes or by paths, each frame is, and is averaged with kShotFilter frames
// before and after. Otherwise lights whose placement is automatic stand on gather samples, the same in every
// frame (not with a time budget or an open shutter, where frames or instants have lights of their own).
LUMIRANK_API void choose_shot_method(const Scene& scene, AnimateSettings& settings);

struct AnimationResult {
  int first = 0, last = -1;    // the frames that were asked for
  int rendered = 0, kept = 0;  // frames: made now, and found finished
  bool interrupted = false;    // cancelled: what is finished stays
};

// Writes frame_0000.exr, …, and each frame's report frame_0000.json, into `folder` (made if absent). A frame
// is finished when its report is there; finished frames are kept, so an interrupted shot goes on where it
// stopped, and several processes may make different frames of one folder. What the frames are made of is in
// shot.json (of the scene a hash of all its files): frames of another scene or with other settings are an
// InputError, and nothing is written over.
// So are frames before the first key of the motion or after its last one.
LUMIRANK_API AnimationResult animate(const Scene& scene, const AnimateSettings& settings,
                                     const std::string& folder, const Sinks& sinks = {});

}  // namespace lumirank
