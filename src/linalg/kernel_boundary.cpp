#include "linalg/kernel_boundary.h"

#include <libsvm/svm.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "base/error.h"

namespace lumirank::linalg {

namespace {

// What an error costs, LIBSVM's own default.
constexpr double kPenalty = 1;

using SvmPoint = std::array<svm_node, 4>;

}  // namespace

struct KernelBoundary::Impl {
  Vec3f middle;
  float scale = 1;
  // The model's support vectors point into these.
  std::vector<SvmPoint> points;
  svm_model* model = nullptr;

  SvmPoint in_units(Vec3f p) const {
    const Vec3f v = (p - middle) * scale;
    return {{{1, static_cast<double>(v.x)},
             {2, static_cast<double>(v.y)},
             {3, static_cast<double>(v.z)},
             {-1, 0.0}}};
  }
};

KernelBoundary::KernelBoundary(std::span<const Vec3f> points, std::span<const std::uint8_t> second,
                               double width)
    : impl_(std::make_unique<Impl>()) {
  const auto of_second = std::ranges::count_if(second, [](std::uint8_t s) { return s != 0; });
  if (of_second == 0 || of_second == static_cast<std::ptrdiff_t>(points.size()))
    throw InternalError("linalg::KernelBoundary: one of the two sets is empty");
  Impl& m = *impl_;
  const auto count = static_cast<float>(points.size());
  for (const Vec3f p : points) m.middle += p / count;
  float square = 0;
  for (const Vec3f p : points) square += length_squared(p - m.middle) / count;
  m.scale = square > 0 ? 1 / std::sqrt(square) : 1.0f;
  std::vector<double> label;
  std::vector<svm_node*> nodes;
  for (const Vec3f p : points) m.points.push_back(m.in_units(p));
  for (std::size_t k = 0; k < points.size(); ++k) {
    nodes.push_back(m.points[k].data());
    label.push_back(second[k] ? 1.0 : -1.0);
  }
  svm_set_print_string_function([](const char*) {});
  svm_parameter parameter{};
  parameter.svm_type = C_SVC, parameter.kernel_type = RBF;
  parameter.gamma = 1 / (2 * width * width);
  parameter.cache_size = 16, parameter.eps = 1e-3, parameter.C = kPenalty, parameter.shrinking = 1;
  const svm_problem problem{static_cast<int>(points.size()), label.data(), nodes.data()};
  m.model = svm_train(&problem, &parameter);
}

KernelBoundary::~KernelBoundary() {
  if (impl_ && impl_->model) svm_free_and_destroy_model(&impl_->model);
}

double KernelBoundary::side(Vec3f point) const {
  const SvmPoint x = impl_->in_units(point);
  double value = 0;
  svm_predict_values(impl_->model, x.data(), &value);
  // Positive is the side of the label that LIBSVM met first.
  return impl_->model->label[0] > 0 ? value : -value;
}

}  // namespace lumirank::linalg
