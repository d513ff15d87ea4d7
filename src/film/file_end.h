// Some decoders are too kind to truncated files, or too loud: libjpeg paints the missing part grey, libpng
// prints. So the skeleton of these two formats is walked before they are decoded.
#pragma once

#include <istream>
#include <string>

namespace lumirank::film {

// Throws InputError if the file begins as a JPEG or PNG and does not go on to the end marker of its format.
void require_file_end(const std::string& filename);
// The same of a file in memory; `name` names it in messages.
void require_file_end(std::istream& in, const std::string& name);

}  // namespace lumirank::film
