// Identity of files: whether two names lead to one.
#pragma once

#include <string>
#include <vector>

namespace lumirank::image {

// Where a write to the name lands: the end of a chain of links, also where no file is there yet. "" if they
// lead in a circle.
std::string end_of_links(const std::string& filename);

// Equal for names of one file, through links and however they are written; also of a file that is yet to be
// made. "" for character devices: what goes into the null device twice destroys nothing.
std::string file_identity(const std::string& filename);

// Throws InputError if two of `outputs` are one file, or one of them is among `inputs`.
void require_distinct(const std::vector<std::string>& outputs, const std::vector<std::string>& inputs);

}  // namespace lumirank::image
