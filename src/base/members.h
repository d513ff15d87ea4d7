// Members of aggregates, by position.
#pragma once

#include <cstddef>
#include <utility>

namespace lumirank {

struct AnyMember {
  template <typename T>
  operator T() const;
};
template <typename T, std::size_t... k>
constexpr bool takes_members(std::index_sequence<k...>) {
  return requires { T{(static_cast<void>(k), AnyMember{})...}; };
}
// Whether an aggregate has exactly so many members.
template <typename T, std::size_t count>
constexpr bool has_members() {
  return takes_members<T>(std::make_index_sequence<count>{}) &&
         !takes_members<T>(std::make_index_sequence<count + 1>{});
}

// f(member) for all of them; at most 16.
template <typename T, typename F>
void for_each_member(const T& t, F&& f) {
  const auto all = [&](const auto&... member) { (f(member), ...); };
  if constexpr (has_members<T, 0>()) {
    all();
  } else if constexpr (has_members<T, 1>()) {
    const auto& [m0] = t;
    all(m0);
  } else if constexpr (has_members<T, 2>()) {
    const auto& [m0, m1] = t;
    all(m0, m1);
  } else if constexpr (has_members<T, 3>()) {
    const auto& [m0, m1, m2] = t;
    all(m0, m1, m2);
  } else if constexpr (has_members<T, 4>()) {
    const auto& [m0, m1, m2, m3] = t;
    all(m0, m1, m2, m3);
  } else if constexpr (has_members<T, 5>()) {
    const auto& [m0, m1, m2, m3, m4] = t;
    all(m0, m1, m2, m3, m4);
  } else if constexpr (has_members<T, 6>()) {
    const auto& [m0, m1, m2, m3, m4, m5] = t;
    all(m0, m1, m2, m3, m4, m5);
  } else if constexpr (has_members<T, 7>()) {
    const auto& [m0, m1, m2, m3, m4, m5, m6] = t;
    all(m0, m1, m2, m3, m4, m5, m6);
  } else if constexpr (has_members<T, 8>()) {
    const auto& [m0, m1, m2, m3, m4, m5, m6, m7] = t;
    all(m0, m1, m2, m3, m4, m5, m6, m7);
  } else if constexpr (has_members<T, 9>()) {
    const auto& [m0, m1, m2, m3, m4, m5, m6, m7, m8] = t;
    all(m0, m1, m2, m3, m4, m5, m6, m7, m8);
  } else if constexpr (has_members<T, 10>()) {
    const auto& [m0, m1, m2, m3, m4, m5, m6, m7, m8, m9] = t;
    all(m0, m1, m2, m3, m4, m5, m6, m7, m8, m9);
  } else if constexpr (has_members<T, 11>()) {
    const auto& [m0, m1, m2, m3, m4, m5, m6, m7, m8, m9, m10] = t;
    all(m0, m1, m2, m3, m4, m5, m6, m7, m8, m9, m10);
  } else if constexpr (has_members<T, 12>()) {
    const auto& [m0, m1, m2, m3, m4, m5, m6, m7, m8, m9, m10, m11] = t;
    all(m0, m1, m2, m3, m4, m5, m6, m7, m8, m9, m10, m11);
  } else if constexpr (has_members<T, 13>()) {
    const auto& [m0, m1, m2, m3, m4, m5, m6, m7, m8, m9, m10, m11, m12] = t;
    all(m0, m1, m2, m3, m4, m5, m6, m7, m8, m9, m10, m11, m12);
  } else if constexpr (has_members<T, 14>()) {
    const auto& [m0, m1, m2, m3, m4, m5, m6, m7, m8, m9, m10, m11, m12, m13] = t;
    all(m0, m1, m2, m3, m4, m5, m6, m7, m8, m9, m10, m11, m12, m13);
  } else if constexpr (has_members<T, 15>()) {
    const auto& [m0, m1, m2, m3, m4, m5, m6, m7, m8, m9, m10, m11, m12, m13, m14] = t;
    all(m0, m1, m2, m3, m4, m5, m6, m7, m8, m9, m10, m11, m12, m13, m14);
  } else if constexpr (has_members<T, 16>()) {
    const auto& [m0, m1, m2, m3, m4, m5, m6, m7, m8, m9, m10, m11, m12, m13, m14, m15] = t;
    all(m0, m1, m2, m3, m4, m5, m6, m7, m8, m9, m10, m11, m12, m13, m14, m15);
  } else {
    static_assert(has_members<T, 0>(), "an aggregate with more members");
  }
}

}  // namespace lumirank
