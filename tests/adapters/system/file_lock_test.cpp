#include "adapters/system/files/file_lock.hpp"

#include <gmock/gmock.h>
#include <sys/stat.h>

#include "tests/support/temporary_folder.hpp"

namespace recald::system {
namespace {

using ::testing::HasSubstr;

TEST(FileLock, OneHolderAtATime) {
  const recald::testing::TemporaryFolder folder;
  {
    const auto first = FileLock::acquire(folder / "a.lock");
    ASSERT_TRUE(first.has_value()) << first.error().message;
    const auto second = FileLock::acquire(folder / "a.lock");
    ASSERT_FALSE(second.has_value());
    EXPECT_THAT(second.error().message, HasSubstr("held by another recald"));
    EXPECT_TRUE(FileLock::acquire(folder / "b.lock").has_value());
  }
  EXPECT_TRUE(FileLock::acquire(folder / "a.lock").has_value());
}

TEST(FileLock, OthersMayNotReadIt) {
  const recald::testing::TemporaryFolder folder;
  const mode_t before = ::umask(0);
  const auto lock = FileLock::acquire(folder / "a.lock");
  ::umask(before);
  ASSERT_TRUE(lock.has_value()) << lock.error().message;
  EXPECT_EQ(std::filesystem::status(folder / "a.lock").permissions(), std::filesystem::perms{0640});
}

TEST(FileLock, NowhereToMakeIt) {
  const recald::testing::TemporaryFolder folder;
  const auto lock = FileLock::acquire(folder / "no" / "a.lock");
  ASSERT_FALSE(lock.has_value());
  EXPECT_EQ(lock.error().code, ErrorCode::io_failed);
}

}  // namespace
}  // namespace recald::system
