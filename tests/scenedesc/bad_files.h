// Files of tests/data that are refused, and what is said of them.
#pragma once

#include <gtest/gtest.h>

#include <string>

namespace lumirank::scenedesc {

struct BadFile {
  const char* name;
  int line;            // 0: binary, or about the file as a whole; -1: of another file, or not to be stated
  const char* phrase;  // in the message
};
inline std::string name_of(const testing::TestParamInfo<BadFile>& file) { return file.param.name; }

// Of scenes; meshes and IES profiles have folders of their own.
inline const std::string kBadFolder = std::string(LUMIRANK_TEST_DATA) + "/bad/";

}  // namespace lumirank::scenedesc
