// Capabilities: what a matrix can tell beside its entries, and what a method needs of it: compared before
// anything is traced or run (methods::require_capabilities), so that nobody finds out half-way that a number
// means something else.
#pragma once

#include <cstdint>
#include <initializer_list>
#include <string>

namespace lumirank::matrix {

enum class Ability : std::uint8_t {
  // Part::visibility is 0 or 1 for every entry. Attenuation, as by thin glass, is part of E then.
  binary_visibility,
  bounds,  // column_set() and row_bounds()
  // RowFeatures
  row_pixel,
  row_position,
  row_normal,
  row_weight,
  row_id,
  // ColumnFeatures
  column_position,
  column_normal,
  column_power,
  column_group,
  column_indirect,
  column_half,
  column_emitted,
  column_id,
};
inline constexpr int kAbilities = 15;

// A set of abilities.
class Capabilities {
 public:
  constexpr Capabilities() = default;
  constexpr Capabilities(std::initializer_list<Ability> abilities) {
    for (const Ability a : abilities) bits_ |= 1u << static_cast<unsigned>(a);
  }
  static constexpr Capabilities all() {
    Capabilities every;
    every.bits_ = (1u << kAbilities) - 1;
    return every;
  }
  constexpr bool has(Ability a) const { return bits_ >> static_cast<unsigned>(a) & 1; }
  constexpr bool empty() const { return bits_ == 0; }
  constexpr Capabilities with(Capabilities others) const { return Capabilities(bits_ | others.bits_); }
  constexpr Capabilities without(Capabilities others) const { return Capabilities(bits_ & ~others.bits_); }
  constexpr bool operator==(const Capabilities&) const = default;

 private:
  constexpr explicit Capabilities(std::uint32_t bits) : bits_(bits) {}
  std::uint32_t bits_ = 0;
};

// "bounds on what groups of lights can add, and the receivers' pixels"; "" for none.
std::string describe(Capabilities capabilities);

// A method's side: what it takes and what it gives.
struct MethodContract {
  Capabilities needs;        // whatever its settings; other features are used where there are any
  bool combination = false;  // one combination of columns for all rows, which splits the picture by light
  // Sums are right for all rows of a pixel together, not for each of them: they cannot be divided anew.
  bool sums_of_pixels = false;
  // It knows what to do with rows and columns of several instants (RowFeatures::instant): others would let a
  // column stand for columns of other instants, of which a row has none.
  bool instants = false;
  // What rays in media are to be for it, unless its settings say otherwise (MethodInfo::segments_wanted).
  enum class Segments {
    pieces,          // eye rays in pieces, longer ones where they are alike
    smooth_pieces,   // the same, and columns that are smooth functions of the rows
    light_pieces,    // eye rays as they are, light rays in pieces
    whole,           // eye rays as they are
    groups,          // smooth pieces that know their slices (RowFeatures::slice)
    groups_and_tree  // the same, and light rays in pieces that know their tree (ColumnFeatures::branch)
  } segments = Segments::pieces;
};
// Of a method that asks for entries alone and gives such a combination.
inline constexpr MethodContract kCombination{{}, true};

}  // namespace lumirank::matrix
