#include "adapters/system/files/write_file.hpp"

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <csignal>
#include <vector>

#include "tests/support/temporary_folder.hpp"

namespace {

/// What was flushed to the disk, in order: "file" or "folder".
std::vector<std::string> flushed;

}  // namespace

/// In the place of the C library's, so that a test sees what is flushed.
extern "C" int fsync(int descriptor) {
  struct stat what {};
  ::fstat(descriptor, &what);
  flushed.emplace_back(S_ISDIR(what.st_mode) ? "folder" : "file");
  return static_cast<int>(::syscall(SYS_fsync, descriptor));
}

namespace recald::system {
namespace {

namespace fs = std::filesystem;
using testing::read_text;
using testing::TemporaryFolder;
using testing::write_text;

/// While it lives, files of this process end at `bytes`: a disk that is full, as write() shows it.
class FileSizeLimit {
 public:
  explicit FileSizeLimit(rlim_t bytes) : handler_(std::signal(SIGXFSZ, SIG_IGN)) {
    ::getrlimit(RLIMIT_FSIZE, &before_);
    const rlimit limit{bytes, before_.rlim_max};
    ::setrlimit(RLIMIT_FSIZE, &limit);
  }
  ~FileSizeLimit() {
    ::setrlimit(RLIMIT_FSIZE, &before_);
    std::signal(SIGXFSZ, handler_);
  }
  FileSizeLimit(const FileSizeLimit&) = delete;
  FileSizeLimit& operator=(const FileSizeLimit&) = delete;

 private:
  void (*handler_)(int);
  rlimit before_{};
};

std::size_t files_in(const fs::path& folder) {
  return static_cast<std::size_t>(
      std::distance(fs::directory_iterator{folder}, fs::directory_iterator{}));
}

TEST(WriteFile, WritesTheBytesAndLeavesNothingElse) {
  const TemporaryFolder folder;
  const std::string bytes{"a\0b\r\n", 5};
  ASSERT_TRUE(write_file(folder / "result.json", bytes).has_value());
  EXPECT_EQ(read_text(folder / "result.json"), bytes);
  EXPECT_EQ(files_in(folder.path()), 1u);
}

// A rename that is not flushed is undone by a power cut.
TEST(WriteFile, FlushesTheFileAndThenTheFolderThatNamesIt) {
  const TemporaryFolder folder;
  flushed.clear();
  ASSERT_TRUE(write_file(folder / "result.json", "text").has_value());
  EXPECT_EQ(flushed, (std::vector<std::string>{"file", "folder"}));
  fs::current_path(folder.path());
  ASSERT_TRUE(write_file("beside.json", "text").has_value());
  EXPECT_EQ(flushed.size(), 4u);
  fs::current_path("/");
}

TEST(WriteFile, ReplacesALongerFileWhole) {
  const TemporaryFolder folder;
  write_text(folder / "result.json", std::string(5000, 'x'));
  ASSERT_TRUE(write_file(folder / "result.json", "short").has_value());
  EXPECT_EQ(read_text(folder / "result.json"), "short");
}

// What a crash halfway left behind must not show through.
TEST(WriteFile, LeftOverPartDoesNoHarm) {
  const TemporaryFolder folder;
  write_text(folder / "result.json.part", std::string(5000, 'x'));
  ASSERT_TRUE(write_file(folder / "result.json", "short").has_value());
  EXPECT_EQ(read_text(folder / "result.json"), "short");
  EXPECT_EQ(files_in(folder.path()), 1u);
}

TEST(WriteFile, FolderThatIsNotThereIsOneSentence) {
  const TemporaryFolder folder;
  const fs::path file = folder / "absent/result.json";
  const auto written = write_file(file, "text");
  ASSERT_FALSE(written.has_value());
  EXPECT_EQ(written.error().code, ErrorCode::io_failed);
  EXPECT_EQ(written.error().message,
            "cannot write '" + file.string() + "': No such file or directory");
}

TEST(WriteFile, TargetThatIsAFolderIsOneSentenceAndNoPartIsLeft) {
  const TemporaryFolder folder;
  fs::create_directory(folder / "result.json");
  const auto written = write_file(folder / "result.json", "text");
  ASSERT_FALSE(written.has_value());
  EXPECT_EQ(written.error().message,
            "cannot write '" + (folder / "result.json").string() + "': Is a directory");
  EXPECT_EQ(files_in(folder.path()), 1u);
}

TEST(WriteFile, OldFileSurvivesWhenTheNewOneCannotBegin) {
  const TemporaryFolder folder;
  write_text(folder / "result.json", "old");
  fs::create_directory(folder / "result.json.part");
  EXPECT_FALSE(write_file(folder / "result.json", "new").has_value());
  EXPECT_EQ(read_text(folder / "result.json"), "old");
}

TEST(WriteFile, OldFileSurvivesWhenTheDiskFillsUpHalfway) {
  const TemporaryFolder folder;
  write_text(folder / "result.json", "old");
  {
    const FileSizeLimit full{4096};
    const auto written = write_file(folder / "result.json", std::string(10'000, 'n'));
    ASSERT_FALSE(written.has_value());
    EXPECT_EQ(written.error().message,
              "cannot write '" + (folder / "result.json").string() + "': File too large");
  }
  EXPECT_EQ(read_text(folder / "result.json"), "old");
  EXPECT_EQ(files_in(folder.path()), 1u);
}

TEST(MakeFolder, MakesWhatIsAboveItToo) {
  const TemporaryFolder folder;
  ASSERT_TRUE(make_folder(folder / "a/b/c").has_value());
  EXPECT_TRUE(fs::is_directory(folder / "a/b/c"));
  EXPECT_TRUE(make_folder(folder / "a/b/c").has_value());
}

TEST(MakeFolder, BelowAFileIsOneSentence) {
  const TemporaryFolder folder;
  write_text(folder / "file", "");
  const auto made = make_folder(folder / "file/below");
  ASSERT_FALSE(made.has_value());
  EXPECT_EQ(made.error().code, ErrorCode::io_failed);
  EXPECT_EQ(made.error().message,
            "cannot create folder '" + (folder / "file/below").string() + "': Not a directory");
}

}  // namespace
}  // namespace recald::system
