#include "scatter/tensor_brdf.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <functional>
#include <map>

#include "base/spectrum.h"

namespace lumirank::scatter {
namespace {

constexpr float kMaxValue = 1e10f;
constexpr std::size_t kMaxValues = std::size_t{1} << 28;
constexpr int kMeanTurns = 12;  // over which an anisotropic material is averaged

struct Tensor {
  std::vector<std::size_t> shape;
  int type = 0;
  std::size_t begin = 0, count = 1;
};
constexpr int kTensorByte = 1, kTensorFloat = 10;  // types

// The fields of a file: "tensor_file" and a zero, two bytes of version, the number of fields, and of each its
// name, dimensions, type, place and shape.
class TensorFile {
 public:
  TensorFile(const std::string& bytes, const std::string& filename, const SourceLocation& where)
      : bytes_(bytes), filename_(filename), where_(where) {
    constexpr std::size_t kVersion = 12;
    at_ = std::min(bytes.size(), kVersion + 2);
    const auto fields = take<std::uint32_t>();
    if (fields > 256) refuse("states " + std::to_string(fields) + " fields");
    for (std::uint32_t k = 0; k < fields; ++k) {
      const auto length = take<std::uint16_t>();
      if (length > bytes.size() - at_) refuse("ends within its header");
      const std::string name = bytes.substr(at_, length);
      at_ += length;
      const auto dimensions = take<std::uint16_t>();
      Tensor tensor;
      tensor.type = take<std::uint8_t>();
      tensor.begin = static_cast<std::size_t>(take<std::uint64_t>());
      for (int d = 0; d < dimensions; ++d) {
        const auto n = take<std::uint64_t>();
        if (n == 0 || n > kMaxValues || tensor.count > kMaxValues / n)
          refuse("has a field of no usable size");
        tensor.shape.push_back(static_cast<std::size_t>(n));
        tensor.count *= static_cast<std::size_t>(n);
      }
      tensors_[name] = tensor;
    }
  }

  [[noreturn]] void refuse(const std::string& what) const {
    throw InputError(where_, "the BRDF file " + filename_ + " " + what,
                     "give a whole .bsdf file of the RGL material database");
  }
  bool has(const std::string& name) const { return tensors_.count(name) > 0; }
  const std::vector<std::size_t>& shape(const std::string& name, std::size_t dimensions) const {
    const auto found = tensors_.find(name);
    if (found == tensors_.end()) refuse("has no field \"" + name + "\"");
    if (found->second.shape.size() != dimensions) refuse("has a field \"" + name + "\" of another shape");
    return found->second.shape;
  }
  // All finite; not below `min_value`, nor so large that sums and products of them are not finite.
  std::vector<float> floats(const std::string& name, std::size_t dimensions, float min_value) const {
    shape(name, dimensions);
    const Tensor& tensor = tensors_.at(name);
    if (tensor.type != kTensorFloat) refuse("has a field \"" + name + "\" that is not of 32-bit numbers");
    std::vector<float> out(tensor.count);
    copy(tensor, out.data(), tensor.count * sizeof(float));
    for (float& v : out) {
      if (!std::isfinite(v)) refuse("has a value that is not a finite number");
      v = std::clamp(v, min_value, kMaxValue);
    }
    return out;
  }
  bool flag(const std::string& name) const {
    shape(name, 1);
    const Tensor& tensor = tensors_.at(name);
    std::uint8_t value = 0;
    if (tensor.type != kTensorByte) refuse("has a field \"" + name + "\" of another type");
    copy(tensor, &value, 1);
    return value != 0;
  }

 private:
  template <typename T>
  T take() {
    T value;
    if (bytes_.size() - at_ < sizeof value) refuse("ends within its header");
    std::memcpy(&value, bytes_.data() + at_, sizeof value);
    at_ += sizeof value;
    return value;
  }
  void copy(const Tensor& tensor, void* to, std::size_t size) const {
    if (tensor.begin > bytes_.size() || size > bytes_.size() - tensor.begin) refuse("is cut off");
    std::memcpy(to, bytes_.data() + tensor.begin, size);
  }

  const std::string& bytes_;
  const std::string& filename_;
  const SourceLocation& where_;
  std::size_t at_ = 0;
  std::map<std::string, Tensor> tensors_;
};

struct GridCell {
  std::size_t at;
  float share;
};
GridCell cell_of(float u, int knots) {
  const float x = std::clamp(u, 0.0f, 1.0f) * static_cast<float>(knots - 1);
  const auto at = std::min(static_cast<std::size_t>(x), static_cast<std::size_t>(knots - 2));
  return {at, x - static_cast<float>(at)};
}
GridCell cell_among(const std::vector<float>& knots, float x) {
  if (knots.size() == 1 || x <= knots.front()) return {0, 0};
  if (x >= knots.back()) return {knots.size() - 2, 1};
  const auto above =
      static_cast<std::size_t>(std::upper_bound(knots.begin(), knots.end(), x) - knots.begin());
  return {above - 1, (x - knots[above - 1]) / (knots[above] - knots[above - 1])};
}

float elevation(Vec3f w) { return std::atan2(std::sqrt(w.x * w.x + w.y * w.y), w.z); }
float root_of(float theta) { return std::sqrt(theta * (2 * kInvPi)); }
float turn_of(float phi) {
  const float u = (phi + kPi) * (0.5f * kInvPi);
  return u - std::floor(u);
}

}  // namespace

bool TensorBrdf::is_one(const std::string& bytes) { return bytes.starts_with("tensor_file"); }

TensorBrdf::TensorBrdf(const std::string& bytes, const std::string& filename, const SourceLocation& where) {
  const TensorFile file(bytes, filename, where);
  phi_ = file.floats("phi_i", 1, -kInfinity), theta_ = file.floats("theta_i", 1, -kInfinity);
  for (const auto* angles : {&phi_, &theta_})
    if (!std::is_sorted(angles->begin(), angles->end(), std::less_equal<>{}))
      file.refuse("has angles out of order");
  isotropic_ = phi_.size() <= 2;
  if (!isotropic_) parts_ = static_cast<int>(std::lround(2 * kPi / (phi_.back() - phi_.front())));
  jacobian_ = file.flag("jacobian");
  const auto grid = [&](const char* name) {
    Grid out;
    const auto& shape = file.shape(name, 2);
    out.rows = static_cast<int>(shape[0]), out.columns = static_cast<int>(shape[1]);
    if (out.rows < 2 || out.columns < 2) file.refuse(std::string("has too small a field \"") + name + "\"");
    out.values = file.floats(name, 2, 0);
    return out;
  };
  ndf_ = grid("ndf"), sigma_ = grid("sigma");

  const std::size_t slices = phi_.size() * theta_.size();
  const auto fits = [&](const std::vector<std::size_t>& shape) {
    return shape[0] == phi_.size() && shape[1] == theta_.size() && shape[shape.size() - 1] >= 2 &&
           shape[shape.size() - 2] >= 2;
  };
  const auto shape = file.shape("vndf", 4);
  if (!fits(shape)) file.refuse("has a field \"vndf\" of another shape");
  rows_ = static_cast<int>(shape[2]), columns_ = static_cast<int>(shape[3]);
  const auto vndf = file.floats("vndf", 4, 0);
  const std::size_t width = shape[3], height = shape[2];
  for (std::size_t s = 0; s < slices; ++s) {
    Visible v;
    v.density.assign(vndf.begin() + static_cast<std::ptrdiff_t>(s * width * height),
                     vndf.begin() + static_cast<std::ptrdiff_t>((s + 1) * width * height));
    v.along.assign(width * height, 0), v.row.assign(height, 0), v.before.assign(height, 0);
    double all = 0;
    for (std::size_t y = 0; y < height; ++y) {
      double sum = 0;
      for (std::size_t x = 1; x < width; ++x) {
        const float* d = &v.density[y * width + x];
        sum += 0.5 * static_cast<double>(d[-1] + d[0]) / static_cast<double>(width - 1);
        v.along[y * width + x] = static_cast<float>(sum);
      }
      v.row[y] = static_cast<float>(sum);
      if (y > 0) all += 0.5 * static_cast<double>(v.row[y - 1] + v.row[y]) / static_cast<double>(height - 1);
      v.before[y] = static_cast<float>(all);
    }
    const float scale = all > 1e-20 ? static_cast<float>(1 / all) : 0;
    for (auto* list : {&v.density, &v.along, &v.row, &v.before})
      for (float& value : *list) value *= scale;
    visible_.push_back(std::move(v));
  }

  // Colors: of spectra, or as they are.
  const bool spectral = file.has("wavelengths");
  const char* name = spectral ? "spectra" : "rgb";
  const auto color_shape = file.shape(name, 5);
  std::vector<Rgb> weights{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  if (spectral) {
    SampledSpectrum hat;
    hat.wavelengths = file.floats("wavelengths", 1, 0);
    if (!std::is_sorted(hat.wavelengths.begin(), hat.wavelengths.end(), std::less_equal<>{}))
      file.refuse("has wavelengths out of order");
    hat.values.assign(hat.wavelengths.size(), 0);
    weights.clear();
    for (float& value : hat.values) value = 1, weights.push_back(reflectance_to_rgb(hat)), value = 0;
  }
  if (!fits(color_shape) || color_shape[2] != weights.size())
    file.refuse(std::string("has a field \"") + name + "\" of another shape");
  color_rows_ = static_cast<int>(color_shape[3]), color_columns_ = static_cast<int>(color_shape[4]);
  const auto values = file.floats(name, 5, 0);
  const std::size_t area = color_shape[3] * color_shape[4];
  for (std::size_t s = 0; s < slices; ++s) {
    std::vector<Rgb> colors(area, Rgb(0));
    for (std::size_t k = 0; k < weights.size(); ++k)
      for (std::size_t i = 0; i < area; ++i)
        colors[i] += weights[k] * values[(s * weights.size() + k) * area + i];
    for (Rgb& c : colors)
      for (int k = 0; k < 3; ++k) c[k] = std::max(0.0f, c[k]);
    colors_.push_back(std::move(colors));
  }
}

float TensorBrdf::Grid::at(Vec2f u) const {
  const GridCell x = cell_of(u.x, columns), y = cell_of(u.y, rows);
  const float* v = &values[y.at * static_cast<std::size_t>(columns) + x.at];
  const float* above = v + columns;
  return lerp(lerp(v[0], v[1], x.share), lerp(above[0], above[1], x.share), y.share);
}

std::array<TensorBrdf::Corner, 4> TensorBrdf::corners(float phi, float theta) const {
  const GridCell p = cell_among(phi_, phi), t = cell_among(theta_, theta);
  const std::size_t n = theta_.size(), p1 = std::min(p.at + 1, phi_.size() - 1),
                    t1 = std::min(t.at + 1, n - 1);
  return {Corner{p.at * n + t.at, (1 - p.share) * (1 - t.share)},
          Corner{p.at * n + t1, (1 - p.share) * t.share}, Corner{p1 * n + t.at, p.share * (1 - t.share)},
          Corner{p1 * n + t1, p.share * t.share}};
}

Vec2f TensorBrdf::uniform(Vec2f u, const std::array<Corner, 4>& corners) const {
  const GridCell x = cell_of(u.x, columns_), y = cell_of(u.y, rows_);
  const auto width = static_cast<std::size_t>(columns_);
  const float dx = 1 / static_cast<float>(columns_ - 1), dy = 1 / static_cast<float>(rows_ - 1);
  float left = 0, whole = 0, below = 0;
  for (const Corner& corner : corners) {
    if (!(corner.share > 0)) continue;
    const Visible& v = visible_[corner.slice];
    const std::size_t a = y.at * width + x.at, b = a + width;
    const float d0 = lerp(v.density[a], v.density[b], y.share),
                d1 = lerp(v.density[a + 1], v.density[b + 1], y.share);
    left += corner.share *
            (lerp(v.along[a], v.along[b], y.share) + dx * x.share * (d0 + 0.5f * x.share * (d1 - d0)));
    const float r0 = v.row[y.at], r1 = v.row[y.at + 1];
    whole += corner.share * lerp(r0, r1, y.share);
    below += corner.share * (v.before[y.at] + dy * y.share * (r0 + 0.5f * y.share * (r1 - r0)));
  }
  return {whole > 0 ? left / whole : 0.5f, below};
}

Rgb TensorBrdf::times_cosine(Vec3f in, Vec3f out) const {
  if (parts_ >= 2) {
    const float y = in.y > 0 ? -1.0f : 1.0f, x = parts_ != 4 ? y : in.x > 0 ? -1.0f : 1.0f;
    in.x *= x, in.y *= y, out.x *= x, out.y *= y;
  }
  const Vec3f m = normalize(in + out);
  const float theta = elevation(in), phi = std::atan2(in.y, in.x), phi_m = std::atan2(m.y, m.x);
  const Vec2f u_in{root_of(theta), turn_of(phi)},
      u_m{root_of(elevation(m)), turn_of(isotropic_ ? phi_m - phi : phi_m)};
  const auto corner = corners(phi, theta);
  const Vec2f place = uniform(u_m, corner);
  const GridCell x = cell_of(place.x, color_columns_), y = cell_of(place.y, color_rows_);
  const auto width = static_cast<std::size_t>(color_columns_);
  Rgb sum(0);
  for (const Corner& c : corner) {
    if (!(c.share > 0)) continue;
    const Rgb* v = &colors_[c.slice][y.at * width + x.at];
    sum += lerp(lerp(v[0], v[1], x.share), lerp(v[width], v[width + 1], x.share), y.share) * c.share;
  }
  if (jacobian_) sum *= ndf_.at(u_m) / std::max(1e-6f, 4 * sigma_.at(u_in));
  return sum;
}

Rgb TensorBrdf::operator()(Vec3f wo, Vec3f wi) const {
  // Measurements are hardly the same both ways; f is their mean.
  const auto both = [&](Vec3f a, Vec3f b) {
    return (times_cosine(a, b) / b.z + times_cosine(b, a) / a.z) * 0.5f;
  };
  if (isotropic_) return both(wo, wi);
  Rgb sum(0);
  for (int k = 0; k < kMeanTurns; ++k) {
    const float turn = 2 * kPi * (static_cast<float>(k) + 0.5f) / kMeanTurns, c = std::cos(turn),
                s = std::sin(turn);
    const auto turned = [&](Vec3f w) { return Vec3f{c * w.x - s * w.y, s * w.x + c * w.y, w.z}; };
    sum += both(turned(wo), turned(wi));
  }
  return sum / kMeanTurns;
}

}  // namespace lumirank::scatter
