#include "image/atomic_file.h"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <filesystem>
#include <fstream>
#include <thread>

#include "base/error.h"
#include "image/file_identity.h"
#include "image/temporary_folder.h"

namespace lumirank::image {
namespace {

namespace fs = std::filesystem;

class AtomicFiles : public TemporaryFolder {};

TEST_F(AtomicFiles, AppearTogetherOrNotAtAll) {
  write_whole_file(path("old"), "before");
  {
    FilesTogether together;
    write_whole_file(path("old"), "after");
    write_whole_file(path("new"), "after");
    EXPECT_EQ(read_bytes(path("old")), "before");
  }
  EXPECT_EQ(read_bytes(path("old")), "before");
  EXPECT_EQ(files(), (std::vector<std::string>{"old"})) << "nothing was committed, and nothing is left";
  FilesTogether together;
  write_whole_file(path("old"), "after");
  write_whole_file(path("new"), "after");
  // Another thread's files are its own.
  std::thread([&] { write_whole_file(path("other"), "at once"); }).join();
  EXPECT_TRUE(fs::exists(path("other")));
  EXPECT_FALSE(fs::exists(path("new")));
  together.commit();
  EXPECT_EQ(read_bytes(path("old")), "after");
  EXPECT_EQ(files().size(), 3u);
}

TEST_F(AtomicFiles, AFullDeviceLetsNoneAppear) {
  FilesTogether together;
  write_whole_file(path("a"), "a");
  fs::create_symlink("/dev/full", path("full"));
  write_whole_file(path("full"), "b");
  EXPECT_THROW(together.commit(), InputError);
  EXPECT_FALSE(fs::exists(path("a")));
}

TEST_F(AtomicFiles, WritesIntoPipesAndStaysOneFileThroughLinks) {
  ASSERT_EQ(mkfifo(path("pipe").c_str(), 0600), 0);
  std::string received;
  std::thread reader([&] { received = read_bytes(path("pipe")); });
  const std::string much(300000, 'x');  // more than a pipe holds
  write_whole_file(path("pipe"), much);
  reader.join();
  EXPECT_EQ(received, much);
  EXPECT_TRUE(fs::is_fifo(path("pipe")));

  write_whole_file(path("real"), "1");
  fs::create_symlink("real", path("link"));
  write_whole_file(path("link"), "2");
  EXPECT_TRUE(fs::is_symlink(path("link")));
  EXPECT_EQ(read_bytes(path("real")), "2");
  fs::create_symlink("later", path("dangling"));
  write_whole_file(path("dangling"), "3");
  EXPECT_EQ(read_bytes(path("later")), "3");
  fs::create_symlink("loop", path("loop"));
  EXPECT_THROW(write_whole_file(path("loop"), "4"), InputError);
}

TEST_F(AtomicFiles, RemovesWhatIsUnderWay) {
  const AtomicFile a(path("a")), b(path("a"));
  EXPECT_NE(a.temporary(), b.temporary());
  EXPECT_EQ(files().size(), 2u);
  remove_temporary_files();
  EXPECT_TRUE(files().empty());
}

TEST_F(AtomicFiles, IdentitiesSeeThroughNames) {
  write_whole_file(path("a"), "");
  fs::create_directory(path("dir"));
  fs::create_directory_symlink("dir", path("dirlink"));
  fs::create_symlink("a", path("link"));
  fs::create_hard_link(path("a"), path("hard"));
  for (const char* same : {"./a", "dir/../a", "link", "hard"})
    EXPECT_EQ(file_identity(path(same)), file_identity(path("a"))) << same;
  EXPECT_EQ(file_identity(path("dir/new")), file_identity(path("dirlink/new")));
  EXPECT_NE(file_identity(path("dir/new")), file_identity(path("new")));
  EXPECT_NO_THROW(require_distinct({path("a"), path("new"), "/dev/null", "/dev/null"}, {path("dir/new")}));
  EXPECT_THROW(require_distinct({path("a"), path("hard")}, {}), InputError);
  EXPECT_THROW(require_distinct({path("new"), path("./new")}, {}), InputError);
  EXPECT_THROW(require_distinct({path("dirlink/new")}, {path("dir/new")}), InputError);
}

}  // namespace
}  // namespace lumirank::image
