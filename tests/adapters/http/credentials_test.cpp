#include "adapters/http/credentials.hpp"

#include <gmock/gmock.h>

#include "tests/support/temporary_folder.hpp"

namespace recald::http {
namespace {

using recald::testing::TemporaryFolder;
using recald::testing::write_text;
using std::filesystem::perms;
using ::testing::HasSubstr;

constexpr const char* kToken = "0123456789abcdef";

TEST(Credentials, ABearerTokenOrAPassword) {
  EXPECT_TRUE(carries_token("Bearer 0123456789abcdef", kToken));
  EXPECT_TRUE(carries_token("bearer  0123456789abcdef ", kToken));
  EXPECT_TRUE(carries_token("Basic YW55Ym9keTowMTIzNDU2Nzg5YWJjZGVm", kToken));  // anybody:…
  EXPECT_TRUE(carries_token("Basic OjAxMjM0NTY3ODlhYmNkZWY=", kToken));          // :…
}

TEST(Credentials, NothingElse) {
  for (const char* wrong :
       {"", "Bearer", "Bearer ", "0123456789abcdef", "Bearer 0123456789abcde",
        "Bearer 0123456789abcdef0", "Bearer 0123456789abcdeF", "Digest 0123456789abcdef",
        "Basic 0123456789abcdef", "Basic YW55Ym9keQ==", "Basic ====", "Basic a",
        "Basic MDEyMzQ1Njc4OWFiY2RlZjo="}) {  // the token as name
    EXPECT_FALSE(carries_token(wrong, kToken)) << wrong;
  }
}

class TokenFile : public ::testing::Test {
 protected:
  TokenFile() { put("0123456789abcdef\n"); }
  void put(std::string_view text) {
    write_text(file_, text);
    std::filesystem::permissions(file_, perms::owner_read | perms::owner_write);
  }
  [[nodiscard]] std::string why_not() const {
    const auto token = read_token_file(file_);
    return token ? "it was taken" : token.error().message;
  }

  TemporaryFolder folder_;
  std::filesystem::path file_ = folder_ / "token";
};

TEST_F(TokenFile, IsReadWithoutItsLineEnd) {
  EXPECT_EQ(read_token_file(file_).value(), "0123456789abcdef");
}

TEST_F(TokenFile, IsTheOwnersAlone) {
  for (const perms others : {perms::group_read, perms::group_write, perms::others_read,
                             perms::others_write, perms::others_exec}) {
    std::filesystem::permissions(file_, perms::owner_read | perms::owner_write | others);
    EXPECT_THAT(why_not(), HasSubstr("can be read by others")) << static_cast<unsigned>(others);
  }
  std::filesystem::permissions(file_, perms::owner_read);
  EXPECT_EQ(why_not(), "it was taken");
}

TEST_F(TokenFile, IsLongEnough) {
  put("0123456789abcde\n");
  EXPECT_THAT(why_not(), HasSubstr("a token of 15 characters"));
  put("  \n");
  EXPECT_THAT(why_not(), HasSubstr("a token of 0 characters"));
}

TEST_F(TokenFile, CanBeSent) {
  put("0123456789 abcdef");
  EXPECT_THAT(why_not(), HasSubstr("cannot be sent"));
}

TEST_F(TokenFile, Exists) {
  std::filesystem::remove(file_);
  EXPECT_THAT(why_not(), HasSubstr("cannot be found"));
}

}  // namespace
}  // namespace recald::http
