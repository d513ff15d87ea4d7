// Wavefront OBJ. Read are v (with colors if they follow), vt, vn and f; groups, materials, lines, points and
// smoothing groups are passed over. Polygons are cut into a fan from their first corner, which is right for
// convex ones only.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "base/error.h"
#include "base/random.h"
#include "scenedesc/meshes/mesh_parts.h"
#include "scenedesc/meshes/mesh_reader.h"
#include "scenedesc/meshes/scan.h"

namespace lumirank::scenedesc {
namespace {

constexpr std::uint32_t kAbsent = 0xffffffffu;

struct Corner {
  std::uint32_t v, vt, vn;
  friend bool operator==(const Corner&, const Corner&) = default;
};

// Numbers distinct corners in the order of their appearance (open addressing, linear probing).
class CornerTable {
 public:
  // The number of `corner`, and whether it is new.
  std::pair<std::uint32_t, bool> number(const Corner& corner) {
    if (2 * (corners_.size() + 1) > slots_.size()) grow();
    std::uint32_t& slot = find(corner);
    if (slot != kAbsent) return {slot, false};
    slot = static_cast<std::uint32_t>(corners_.size());
    corners_.push_back(corner);
    return {slot, true};
  }
  const std::vector<Corner>& corners() const { return corners_; }

 private:
  std::uint32_t& find(const Corner& c) {
    const std::uint64_t h = mix64(mix64((std::uint64_t{c.v} << 32) | c.vt) + c.vn);
    for (std::size_t k = h & (slots_.size() - 1);; k = (k + 1) & (slots_.size() - 1))
      if (slots_[k] == kAbsent || corners_[slots_[k]] == c) return slots_[k];
  }
  void grow() {
    slots_.assign(std::max<std::size_t>(1024, 2 * slots_.size()), kAbsent);
    for (std::size_t k = 0; k < corners_.size(); ++k) find(corners_[k]) = static_cast<std::uint32_t>(k);
  }

  std::vector<std::uint32_t> slots_;
  std::vector<Corner> corners_;
};

class ObjParser {
 public:
  ObjParser(const std::string& bytes, const std::string& filename)
      : p_(bytes.data()), end_(bytes.data() + bytes.size()), filename_(filename) {}

  MeshData parse() {
    if (std::string_view(p_, std::min<std::size_t>(3, end_ - p_)) == "\xef\xbb\xbf")
      p_ += 3;  // byte order mark
    while (p_ != end_) {
      ++line_;
      statement();
      skip_line();
    }
    return assemble();
  }

 private:
  [[noreturn]] void fail(const std::string& message) const {
    throw InputError({filename_, line_}, message, "repair or export the file again");
  }

  // To the first character after the line; a backslash before the line's end joins it with the next.
  void skip_line() {
    while (p_ != end_ && *p_ != '\n') ++p_;
    if (p_ != end_) ++p_;
  }

  bool at_line_end() {
    for (;;) {
      skip_blanks(p_, end_);
      if (p_ == end_ || *p_ == '\n' || *p_ == '#') return true;
      if (*p_ != '\\') return false;
      const char* q = p_ + 1;
      skip_blanks(q, end_);
      if (q == end_ || *q != '\n') return false;
      p_ = q + 1;
      ++line_;
    }
  }

  template <typename Real = float>
  Real number(const char* what) {
    Real value = 0;
    if (at_line_end()) fail(std::string(what) + " has too few numbers");
    const char* first = p_;
    if (!parse_float(p_, end_, value)) fail(quoted_word(take_word(first, end_)) + " is not a number");
    return value;
  }

  void statement() {
    skip_blanks(p_, end_);
    const char* first = p_;
    while (p_ != end_ && !is_blank(*p_) && *p_ != '\n') {
      // A text file has no NUL.
      if (*p_ == '\0') fail("this is not a text file");
      ++p_;
    }
    const std::string_view word(first, static_cast<std::size_t>(p_ - first));
    if (word == "v")
      vertex();
    else if (word == "vt")
      texture_coordinate();
    else if (word == "vn")
      normals_.push_back(triple("a normal"));
    else if (word == "f" || word == "fo")
      polygon();
  }

  Vec3f triple(const char* what) {
    Vec3f a;
    for (int i = 0; i < 3; ++i) a[i] = number(what);
    return a;
  }

  void vertex() {
    Vec3d p;
    for (int i = 0; i < 3; ++i) p[i] = number<double>("a vertex");
    if (!is_finite(static_cast<Vec3f>(p))) fail("a vertex is not finite");
    positions_.push_back(p);
    // What may follow: a weight, or a color, or both.
    std::array<float, 4> rest{};
    std::size_t n = 0;
    while (n < rest.size() && !at_line_end()) rest[n++] = number("a vertex");
    if (n < 3) {
      if (!colors_.empty()) colors_.push_back(Rgb(1));
      return;
    }
    if (colors_.empty()) colors_.resize(positions_.size() - 1, Rgb(1));
    colors_.push_back({rest[n - 3], rest[n - 2], rest[n - 1]});
  }

  void texture_coordinate() {
    Vec2f uv{number("a texture coordinate"), 0};
    if (!at_line_end()) uv.y = number("a texture coordinate");
    uvs_.push_back(uv);
  }

  // 1-based, or counted back from the last one so far.
  std::uint32_t resolve(std::int64_t index, std::size_t count, const char* what) const {
    const auto n = static_cast<std::int64_t>(count);
    if (index >= 1 && index <= n) return static_cast<std::uint32_t>(index - 1);
    if (index < 0 && index >= -n) return static_cast<std::uint32_t>(n + index);
    fail("a face names " + std::string(what) + " " + std::to_string(index) + ", but there are " +
         std::to_string(n) + " so far");
  }

  std::int64_t face_index() {
    std::int64_t index = 0;
    const char* first = p_;
    if (!parse_integer(p_, end_, index)) fail(quoted_word(take_word(first, end_)) + " is not a face index");
    return index;
  }

  // v, v/vt, v//vn or v/vt/vn
  std::uint32_t corner() {
    Corner c{resolve(face_index(), positions_.size(), "vertex"), kAbsent, kAbsent};
    if (p_ != end_ && *p_ == '/') {
      ++p_;
      if (p_ != end_ && *p_ != '/' && !is_blank(*p_) && *p_ != '\n')
        c.vt = resolve(face_index(), uvs_.size(), "texture coordinate");
      if (p_ != end_ && *p_ == '/') {
        ++p_;
        if (p_ != end_ && !is_blank(*p_) && *p_ != '\n')
          c.vn = resolve(face_index(), normals_.size(), "normal");
      }
    }
    if (p_ != end_ && !is_blank(*p_) && *p_ != '\n')
      fail("a face index is followed by " + quoted_word({p_, 1}));
    const auto [number, fresh] = table_.number(c);
    if (fresh && number == kAbsent) fail("the mesh has more than 4,294,967,295 vertices");
    return number;
  }

  void polygon() {
    std::uint32_t first = 0, previous = 0;
    std::size_t n = 0;
    while (!at_line_end()) {
      const std::uint32_t c = corner();
      if (n == 0) first = c;
      if (n >= 2) indices_.insert(indices_.end(), {first, previous, c});
      previous = c;
      ++n;
    }
    if (n < 3) ++small_polygons_;
    if (n > 4) ++large_polygons_;
  }

  MeshData assemble() {
    MeshData mesh;
    mesh.indices = std::move(indices_);
    bool any_uv = false, any_normal = false;
    for (const Corner& c : table_.corners()) any_uv |= c.vt != kAbsent, any_normal |= c.vn != kAbsent;
    const std::size_t n = table_.corners().size();
    auto [positions, origin] = near_positions(positions_);
    mesh.origin = origin;
    mesh.positions.reserve(n);
    if (any_uv) mesh.uvs.reserve(n);
    if (any_normal) mesh.normals.reserve(n);
    if (!colors_.empty()) mesh.colors.reserve(n);
    std::size_t without_uv = 0;
    for (const Corner& c : table_.corners()) {
      mesh.positions.push_back(positions[c.v]);
      if (any_uv) mesh.uvs.push_back(c.vt != kAbsent ? uvs_[c.vt] : Vec2f{});
      if (any_normal) mesh.normals.push_back(c.vn != kAbsent ? normals_[c.vn] : Vec3f{});
      if (!colors_.empty()) mesh.colors.push_back(colors_[c.v]);
      without_uv += any_uv && c.vt == kAbsent;
    }
    if (without_uv > 0)
      mesh.mended.push_back({std::to_string(without_uv) + " vertices without texture coordinates", "(0, 0)"});
    if (small_polygons_ > 0)
      mesh.left_out.push_back(std::to_string(small_polygons_) + (small_polygons_ == 1 ? " face" : " faces") +
                              " with fewer than 3 corners");
    if (large_polygons_ > 0)
      mesh.mended.push_back({std::to_string(large_polygons_) + " polygons of more than 4 corners",
                             "fans of triangles (wrong where they are not convex)"});
    return checked(std::move(mesh), filename_);
  }

  const char* p_;
  const char* end_;
  const std::string& filename_;
  int line_ = 0;
  std::vector<Vec3d> positions_;
  std::vector<Vec3f> normals_;
  std::vector<Vec2f> uvs_;
  std::vector<Rgb> colors_;
  CornerTable table_;
  std::vector<std::uint32_t> indices_;
  std::size_t small_polygons_ = 0, large_polygons_ = 0;
};

}  // namespace

MeshData parse_obj(const std::string& bytes, const std::string& filename) {
  return ObjParser(bytes, filename).parse();
}

}  // namespace lumirank::scenedesc
