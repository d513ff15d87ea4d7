// Corpus of scenes that are not whole: each case a scene of a few lines, and what loading it must come to.
#pragma once

#include <string>
#include <vector>

namespace lumirank::test {

struct LoadingCase {
  enum class Format { xml, pbrt, gltf };
  enum class Outcome {
    refused,  // an InputError that names the scene's file and `line`, and says `says`
    warned,   // it loads, and a warning at `line` says `says`
    loads     // it loads without a warning
  };
  const char* name;
  Format format;
  std::string text;
  Outcome outcome;
  std::string says = {};
  int line = 0;  // 0: any
  std::size_t left_out = 0;
  bool allow_missing = false, strict = false;
};

// A scene with a camera on line 1 and a floor and a lamp on line 2; `body` begins on line 3.
inline std::string xml_scene(const std::string& body) {
  return "<scene version=\"3.0.0\"><sensor type=\"perspective\"/>\n"
         "<shape type=\"rectangle\"/><emitter type=\"point\"/>\n" +
         body + "\n</scene>\n";
}
// The same; `body` begins on line 3.
inline std::string pbrt_scene(const std::string& body) {
  return "WorldBegin\nLightSource \"point\" Shape \"disk\"\n" + body + "\n";
}
// One mesh of one primitive; `more` are further members of the root, from line 9 on. The buffer: four
// positions of a square, then the indices 0 1 2 and 0 0 0. Accessors: three positions; the indices 0 0 0;
// three positions of a second buffer, `buffer`; sixteen million zeros; two positions.
inline std::string gltf_scene(const std::string& primitive, const std::string& more = "",
                              const std::string& buffer = {}) {
  // 48 bytes of positions, 12 of 16-bit indices.
  const std::string data =
      "data:;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAACAPwAAgD8AAAAAAAAAAAAAgD8AAAAAAAABAAIAAAAAAAAA";
  return "{\"asset\": {\"version\": \"2.0\"}, \"scene\": 0, \"scenes\": [{\"nodes\": [0, 1]}],\n"
         "\"nodes\": [{\"mesh\": 0, \"name\": \"floor\"}, {\"mesh\": 1, \"name\": \"cup\"}],\n"
         "\"meshes\": [{\"primitives\": [{\"attributes\": {\"POSITION\": 0}}]},\n"
         "{\"primitives\": [" +
         primitive +
         "]}],\n"
         "\"buffers\": [{\"byteLength\": 60, \"uri\": \"" +
         data + "\"}" + (buffer.empty() ? "" : ", " + buffer) +
         "],\n"
         "\"bufferViews\": [{\"buffer\": 0, \"byteLength\": 48}, {\"buffer\": 0, \"byteOffset\": 48, "
         "\"byteLength\": 12}, {\"buffer\": 1, \"byteLength\": 48}],\n"
         "\"accessors\": [{\"bufferView\": 0, \"componentType\": 5126, \"count\": 3, \"type\": \"VEC3\"},\n"
         "{\"bufferView\": 1, \"byteOffset\": 6, \"componentType\": 5123, \"count\": 3, \"type\": "
         "\"SCALAR\"},"
         " {\"bufferView\": 2, \"componentType\": 5126, \"count\": 3, \"type\": \"VEC3\"},"
         " {\"componentType\": 5126, \"count\": 16000000, \"type\": \"VEC3\"},"
         " {\"bufferView\": 0, \"componentType\": 5126, \"count\": 2, \"type\": \"VEC3\"}]" +
         (more.empty() ? "" : ",\n" + more) + "}\n";
}

// By theme, in files of their own.
std::vector<LoadingCase> meshes_without_triangles();
std::vector<LoadingCase> broken_files();
std::vector<LoadingCase> missing_files();
std::vector<LoadingCase> nested_without_end();
std::vector<LoadingCase> odd_scenes();

// Writes the files that the cases name into `folder`.
void write_corpus_files(const std::string& folder);

}  // namespace lumirank::test
