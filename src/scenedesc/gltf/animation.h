// The animations of a glTF file (glTF 2.0, section 3.11 and appendix C; KHR_animation_pointer): at a moment
// they are other numbers in the file, so a moment is read as a file that has them.
#pragma once

#include <string>
#include <vector>

#include "scenedesc/gltf/accessors.h"
#include "scenedesc/gltf/element.h"

namespace lumirank::scenedesc::gltf {

class Animation {
 public:
  // `clip`: an animation's name, or its number from 0 where it has none; "": the first; "*": all at once.
  // Throws InputError for a clip that the file does not have, key times that do not rise, and values that are
  // too many, too few, or of the wrong kind. A file without animations has one that changes nothing.
  Animation(const Element& root, Accessors& accessors, const std::string& clip);

  bool empty() const { return tracks_.empty(); }
  // Seconds of the first and the last key.
  double begin() const { return begin_; }
  double end() const { return end_; }
  // What moves, for a listing: "nodes[3] (Fox): rotation".
  const std::vector<std::string>& moving() const { return moving_; }

  // The file as it stands at `seconds`; before the first key as at it, after the last one as at that.
  Json at(const Json& document, double seconds) const;

 private:
  enum class Interpolation { step, linear, cubic };
  // A property of the file and its values over time.
  struct Track {
    std::vector<std::string> path;  // keys and indices from the root
    bool is_list = false, is_rotation = false, is_flag = false;
    Interpolation interpolation = Interpolation::linear;
    std::size_t components = 0;  // numbers of one value
    std::vector<float> times, values;
    int line = 0;

    std::vector<double> at(double seconds) const;
  };
  void add_clip(const Element& animation);
  void add_channel(const Element& animation, const Element& channel);
  Track target_of(const Element& channel) const;
  void set_keys(const Element& sampler, Track& track);
  std::size_t component_count(const Element& channel, Track& track) const;

  Element root_;
  Accessors& accessors_;
  std::vector<Track> tracks_;
  std::vector<std::string> moving_;
  double begin_ = 0, end_ = 0;
};

// The names that `clip` may have, in the order of the file.
std::vector<std::string> clip_names(const Element& root);

}  // namespace lumirank::scenedesc::gltf
