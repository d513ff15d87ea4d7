// How large the passes of a budget are, so that all of it is used: a pass may draw fewer or more lights for
// each receiver, and have as many fewer or more; and it may be of some of the film's pixels, so that several
// of them show all.
#pragma once

namespace lumirank::pipeline {

class PassPlan {
 public:
  // Size of a pass, in eighths of a whole one.
  static constexpr int kWhole = 8, kMax = 16;

  // Whether passes may be of another size than whole; how many of them show every pixel.
  explicit PassPlan(bool resizes, int parts = 1) : resizes_(resizes), parts_(parts) {}

  // Before any pass: seconds that one takes whatever its size, and what each eighth of it takes.
  void expect(double fixed, double per_eighth);
  // A pass took so many seconds, `drawing` of them in proportion to its size.
  void took(int eighths, double seconds, double drawing);

  // Of the next pass; 0: none fits into `left` seconds. Until every pixel is shown one always is.
  int next(double left) const;

 private:
  int passes_wanted(double left) const;
  // Of each, where so many passes fill these seconds.
  int eighths_of(int passes, double seconds) const;
  bool every_pixel_is_shown() const { return passes_ >= parts_; }
  double whole() const { return fixed_ + kWhole * per_eighth_; }

  bool resizes_;
  int parts_, passes_ = 0;
  double weight_ = 0, eighths_ = 0, seconds_ = 0, drawing_ = 0;  // of passes so far, the later the more
  double fixed_ = 0, per_eighth_ = 0;
};

}  // namespace lumirank::pipeline
