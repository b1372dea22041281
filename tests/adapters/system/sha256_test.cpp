/// Digests of FIPS 180-2, appendix B.
#include "adapters/system/files/sha256.hpp"

#include <gtest/gtest.h>

#include "tests/support/temporary_folder.hpp"

namespace recald::system {
namespace {

constexpr const char* kOfAbc = "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad";
constexpr const char* kOfNothing =
    "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855";
constexpr const char* kOfAMillionA =
    "cdc76e5c9914fb9281a1c7e284d73e67f1809a48a497200e046d39ccc7112cd0";

TEST(Sha256, MeetsThePublishedDigests) {
  Sha256 abc;
  abc.add("abc");
  EXPECT_EQ(abc.hex(), kOfAbc);
  EXPECT_EQ(Sha256{}.hex(), kOfNothing);
}

TEST(Sha256, PartsCountAsTheWhole) {
  Sha256 digest;
  digest.add("a");
  digest.add("");
  digest.add("bc");
  EXPECT_EQ(digest.hex(), kOfAbc);
}

TEST(Sha256, OfAFileIsThatOfItsBytes) {
  const testing::TemporaryFolder folder;
  testing::write_text(folder / "abc", "abc");
  testing::write_text(folder / "empty", "");
  testing::write_text(folder / "long", std::string(1'000'000, 'a'));  // more than one chunk
  const auto digest_of = [&](const char* name) {
    Sha256 digest;
    EXPECT_TRUE(digest.add_file(folder / name).has_value());
    return digest.hex();
  };
  EXPECT_EQ(digest_of("abc"), kOfAbc);
  EXPECT_EQ(digest_of("empty"), kOfNothing);
  EXPECT_EQ(digest_of("long"), kOfAMillionA);
}

TEST(Sha256, MissingFileIsNamed) {
  const testing::TemporaryFolder folder;
  Sha256 digest;
  const auto added = digest.add_file(folder / "absent.csv");
  ASSERT_FALSE(added.has_value());
  EXPECT_EQ(added.error().code, ErrorCode::not_found);
  EXPECT_EQ(added.error().message, "cannot open '" + (folder / "absent.csv").string() + "'");
}

TEST(Sha256, FolderCannotBeRead) {
  const testing::TemporaryFolder folder;
  Sha256 digest;
  const auto added = digest.add_file(folder.path());
  ASSERT_FALSE(added.has_value());
  EXPECT_EQ(added.error().code, ErrorCode::io_failed);
  EXPECT_EQ(added.error().message, "cannot read '" + folder.path().string() + "'");
}

}  // namespace
}  // namespace recald::system
