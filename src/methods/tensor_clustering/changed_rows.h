// Looks for the rows of a frame whose light is not what was carried there: a shadow or a highlight that moves
// over a surface which itself stays. Ours; the paper carries whatever the clusters say.
//
// Some rows, evenly spread over the picture, are asked; where one has changed its surroundings are asked more
// densely, down to single rows.
#pragma once

#include <functional>
#include <span>
#include <vector>

#include "matrix/lighting_matrix.h"

namespace lumirank::methods {

// Of the given rows, in their order, which have changed.
using HasChanged = std::function<std::vector<bool>(std::span<const matrix::Index>)>;

// `pixel`: of every row, or empty (rows then lie on a line). Every row that was asked, once, in the order of
// asking. Rows are asked in squares of 8, then 4, 2 and 1 pixels: in every square of 8 one, in a smaller one
// if the one around it, or one that it touches, has changed.
std::vector<matrix::Index> ask_for_changes(std::span<const Vec2f> pixel, std::size_t rows,
                                           const HasChanged& has_changed);

}  // namespace lumirank::methods
