#include "scenedesc/volumes/grid_file.h"

#include <filesystem>
#include <fstream>

#include "scenedesc/schema/files.h"
#include "scenedesc/volumes/nanovdb_file.h"
#include "scenedesc/volumes/openvdb_file.h"
#include "scenedesc/volumes/vol_file.h"

namespace lumirank::scenedesc {
namespace {

// Files are named either way, and their first bytes know better.
bool is_nanovdb(const std::string& filename) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(filename, error)) read_file(filename, {});  // says what it is instead
  std::string head(8, '\0');
  std::ifstream in(filename, std::ios::binary);
  in.read(head.data(), static_cast<std::streamsize>(head.size()));
  head.resize(static_cast<std::size_t>(in.gcount()));
  if (looks_like_nanovdb(head)) return true;
  if (looks_like_openvdb(head)) return false;
  throw InputError({filename, 0},
                   head.empty() ? "the file is empty" : "this is neither an OpenVDB nor a NanoVDB file",
                   head.empty() ? "copy or export it again" : "export the grid as .vdb or .nvdb");
}

}  // namespace

GridFile read_grid_file(const GridFileDesc& file) {
  if (file.sparse())
    return is_nanovdb(file.filename) ? parse_nanovdb(read_file(file.filename, {}), file.filename, file.grid)
                                     : read_openvdb(file.filename, file.grid);
  GridFile out;
  out.numbers = read_vol(file.filename, &out.floats);
  return out;
}

std::vector<std::string> grid_names(const std::string& filename) {
  return is_nanovdb(filename) ? nanovdb_grid_names(read_file(filename, {}), filename)
                              : openvdb_grid_names(filename);
}

}  // namespace lumirank::scenedesc
