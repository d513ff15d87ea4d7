// Chunks of a shot that are clustered together, and the pictures that a chunk leaves for the one after it.
//
// A chunk has `length` frames of its own and goes on for `overlap` more: the pictures of those are its tail,
// kept in the folder as files, and blended into the next chunk's own until their frames are finished. Chunks
// are counted from the first frame of the motion, so they are the same whatever part of a shot is asked for.
#pragma once

#include <algorithm>
#include <string>

#include "lumirank/lumirank.h"

namespace lumirank::api {

struct Chunk {
  int first = 0, last = 0;  // its own frames
  int tail_last = 0;        // of its tail, which begins after `last`; `last`: it has none
  int size() const { return tail_last - first + 1; }
};

class ShotChunks {
 public:
  // Frames first_key … last_key are the motion's.
  ShotChunks(int first_key, int last_key, int length, int overlap)
      : first_key_(first_key), last_key_(last_key), length_(length), overlap_(std::min(overlap, length)) {}

  Chunk of(int frame) const;
  Chunk before(const Chunk& chunk) const { return of(chunk.first - 1); }
  // The part that a chunk's own picture has in one of its frames, where the tail of the one before has the
  // rest; 1: all.
  double part(int frame) const;

 private:
  int first_key_, last_key_, length_, overlap_;
};

// One frame's picture as the chunk before it has it; exact to the bit.
class TailPicture {
 public:
  TailPicture(const std::string& folder, int frame);
  // Of this size, readable.
  bool exists() const;
  void write(const Picture& picture) const;
  // picture = part · picture + (1 − part) · tail. Throws InputError for a tail of another size.
  void blend_into(Picture& picture, double part) const;
  void remove() const;

 private:
  std::string file_;
};

}  // namespace lumirank::api
