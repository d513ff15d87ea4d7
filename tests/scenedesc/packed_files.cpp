// Files packed by gzip, as pbrt's scenes have them.
#include <zlib.h>

#include <fstream>

#include "scenedesc/pbrt_scene.h"
#include "scenedesc/schema/files.h"
#include "support/scene_file.h"

namespace lumirank::scenedesc {
namespace {

std::string zipped(const std::string& text) {
  z_stream stream{};
  EXPECT_EQ(deflateInit2(&stream, 6, Z_DEFLATED, 15 + 16, 8, Z_DEFAULT_STRATEGY), Z_OK);
  std::string out(deflateBound(&stream, text.size()) + 64, '\0');
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(text.data()));
  stream.avail_in = static_cast<uInt>(text.size());
  stream.next_out = reinterpret_cast<Bytef*>(out.data());
  stream.avail_out = static_cast<uInt>(out.size());
  EXPECT_EQ(deflate(&stream, Z_FINISH), Z_STREAM_END);
  out.resize(stream.total_out);
  deflateEnd(&stream);
  return out;
}

void write(const std::string& name, const std::string& bytes) {
  std::ofstream(name, std::ios::binary) << bytes;
}

std::string message_of(const std::string& name, std::uintmax_t max_bytes = UINTMAX_MAX) {
  try {
    read_file(name, {}, max_bytes);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(PackedFiles, AreUnpackedWhereTheirNameSaysSo) {
  const test::TemporaryFolder folder;
  const std::string text = std::string(3'000'000, 'a') + "the end", name = folder / "a.gz";
  write(name, zipped(text));
  EXPECT_EQ(read_file(name, {}), text);
  // Two in one, as `cat` makes them, and what is no member behind it.
  write(name, zipped("one") + zipped("two") + std::string(5, '\0'));
  EXPECT_EQ(read_file(name, {}), "onetwo");
  write(name, "plain");
  EXPECT_EQ(read_file(name, {}), "plain");
  const std::string other = folder / "a.bin";
  write(other, zipped(text));
  EXPECT_EQ(read_file(other, {}), zipped(text));
}

TEST(PackedFiles, BadOnesAreRefused) {
  const test::TemporaryFolder folder;
  const std::string name = folder / "a.gz", whole = zipped(std::string(100'000, 'b'));
  write(name, whole.substr(0, whole.size() / 2));
  EXPECT_NE(message_of(name).find("cut off"), std::string::npos) << message_of(name);
  std::string broken = whole;
  broken[broken.size() / 2] = static_cast<char>(broken[broken.size() / 2] ^ 0x55);
  broken[broken.size() - 6] = static_cast<char>(broken[broken.size() - 6] ^ 0x55);  // the check sum
  write(name, broken);
  EXPECT_NE(message_of(name).find("broken"), std::string::npos) << message_of(name);
  // A hundred bytes that unpack to a thousand times as much.
  write(name, whole);
  EXPECT_NE(message_of(name, 50'000).find("unpacked"), std::string::npos) << message_of(name, 50'000);
  EXPECT_EQ(message_of(name, 100'000), "");
}

TEST(PackedFiles, PbrtIncludesThem) {
  const test::TemporaryFolder folder;
  const std::string name = folder / "curves.pbrt.gz";
  write(name, zipped("Shape \"sphere\" \"float radius\" 2\nShape \"sphere\"\n"));
  EXPECT_EQ(pbrt_world("Include \"" + name + "\"").shapes.size(), 2u);
  const std::string mesh = folder / "m.ply.gz";
  write(mesh,
        zipped("ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float "
               "z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 "
               "0\n3 0 1 2\n"));
  const SceneDesc scene = pbrt_world("Shape \"plymesh\" \"string filename\" \"" + mesh + "\"");
  EXPECT_EQ(read_mesh(shape<MeshFileDesc>(scene)).triangle_count(), 1u);
}

}  // namespace
}  // namespace lumirank::scenedesc
