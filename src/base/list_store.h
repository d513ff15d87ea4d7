// Short lists of plain values, each kept once: equal lists (bit for bit) get the same id.
#pragma once

#include <cstdint>
#include <cstring>
#include <span>
#include <type_traits>
#include <vector>

#include "base/error.h"
#include "base/random.h"

namespace lumirank {

template <typename T>
class ListStore {
  static_assert(std::is_trivially_copyable_v<T> && sizeof(T) % 4 == 0);

 public:
  std::size_t size() const { return offsets_.size() - 1; }
  std::span<const T> operator[](std::uint32_t id) const {
    return {values_.data() + offsets_[id], offsets_[id + 1] - offsets_[id]};
  }

  // Ids are given in the order in which lists first appear.
  std::uint32_t intern(std::span<const T> list) {
    if (2 * (size() + 1) > table_.size()) grow();
    const std::size_t mask = table_.size() - 1;
    for (std::size_t slot = hash(list) & mask;; slot = (slot + 1) & mask) {
      const std::uint32_t id = table_[slot];
      if (id == kEmpty) {
        values_.insert(values_.end(), list.begin(), list.end());
        if (values_.size() > 0xffffffffull)
          throw InternalError("transport::ListStore: more than 2^32 values in one store");
        offsets_.push_back(static_cast<std::uint32_t>(values_.size()));
        return table_[slot] = static_cast<std::uint32_t>(size() - 1);
      }
      if (equal((*this)[id], list)) return id;
    }
  }

  // Gives back the look-up table and spare capacity. A later intern() makes the table again.
  void shrink() {
    table_ = std::vector<std::uint32_t>();  // (assigning {} would keep the capacity)
    offsets_.shrink_to_fit();
    values_.shrink_to_fit();
  }
  std::size_t memory_bytes() const {
    return values_.capacity() * sizeof(T) + (offsets_.capacity() + table_.capacity()) * sizeof(std::uint32_t);
  }

 private:
  static constexpr std::uint32_t kEmpty = 0xffffffffu;

  static bool equal(std::span<const T> a, std::span<const T> b) {
    return a.size() == b.size() && (a.empty() || std::memcmp(a.data(), b.data(), a.size_bytes()) == 0);
  }
  static std::uint64_t hash(std::span<const T> list) {
    std::uint64_t h = list.size();
    const auto* bytes = reinterpret_cast<const unsigned char*>(list.data());
    for (std::size_t i = 0; i < list.size_bytes(); i += 4) {
      std::uint32_t word;
      std::memcpy(&word, bytes + i, 4);
      h = mix64(h ^ word);
    }
    return h;
  }
  void grow() {
    std::size_t capacity = 16;
    while (capacity < 4 * (size() + 1)) capacity *= 2;
    table_.assign(capacity, kEmpty);
    for (std::uint32_t id = 0; id < size(); ++id) {
      std::size_t slot = hash((*this)[id]) & (capacity - 1);
      while (table_[slot] != kEmpty) slot = (slot + 1) & (capacity - 1);
      table_[slot] = id;
    }
  }

  std::vector<std::uint32_t> offsets_{0};
  std::vector<T> values_;
  std::vector<std::uint32_t> table_;  // open addressing; a power of two
};

}  // namespace lumirank
