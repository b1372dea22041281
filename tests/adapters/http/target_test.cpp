#include "adapters/http/target.hpp"

#include <gmock/gmock.h>

namespace recald::http {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Pair;

std::string why_not(std::string_view text) {
  const auto target = parse_target(text);
  return target ? "it was taken" : target.error().message;
}

TEST(Target, PathAndQueryAreDecoded) {
  const auto target =
      parse_target("/api/v1/meters/k%C3%BCche?from=2024-03-01T00%3A00Z&x=a+b&&flag");
  ASSERT_TRUE(target.has_value()) << target.error().message;
  EXPECT_EQ(target->path, "/api/v1/meters/küche");
  EXPECT_THAT(target->query,
              ElementsAre(Pair("flag", ""), Pair("from", "2024-03-01T00:00Z"), Pair("x", "a b")));
}

TEST(Target, APlusInAPathIsAPlus) { EXPECT_EQ(parse_target("/a+b")->path, "/a+b"); }

TEST(Target, AProxyMayNameTheHost) {
  EXPECT_EQ(parse_target("http://tower:8080/healthz?a=1")->path, "/healthz");
  EXPECT_EQ(parse_target("http://tower")->path, "/");
}

TEST(Target, AnEmptyQueryIsNone) { EXPECT_THAT(parse_target("/?")->query, IsEmpty()); }

TEST(Target, WhatIsWrongIsSaid) {
  EXPECT_THAT(why_not(""), HasSubstr("does not begin with '/'"));
  EXPECT_THAT(why_not("*"), HasSubstr("does not begin with '/'"));
  EXPECT_THAT(why_not("/%"), HasSubstr("two hexadecimal digits"));
  EXPECT_THAT(why_not("/%4"), HasSubstr("two hexadecimal digits"));
  EXPECT_THAT(why_not("/?a=%zz"), HasSubstr("two hexadecimal digits"));
  EXPECT_THAT(why_not("/%00"), HasSubstr("control character"));
  EXPECT_THAT(why_not("/?a=%0d%0aSet-Cookie"), HasSubstr("control character"));
  EXPECT_THAT(why_not("/a#b"), HasSubstr("'#'"));
  EXPECT_THAT(why_not("/?a=1&a=2"), HasSubstr("'a' more than once"));
  EXPECT_THAT(why_not("/" + std::string(8 * 1024, 'a')), HasSubstr("8 KiB"));
}

TEST(Target, ThirtyTwoParametersAndNoMore) {
  std::string text = "/?";
  for (int i = 0; i < 32; ++i) text += "p" + std::to_string(i) + "=&";
  EXPECT_EQ(parse_target(text)->query.size(), 32u);
  EXPECT_THAT(why_not(text + "one=more"), HasSubstr("more than 32"));
}

// Each is a classic way past a filter that looks at bytes before they are decoded.
TEST(Target, OnlyUtf8AsUnicodeHasIt) {
  for (const char* wrong : {"/%FF", "/%C0%AF", "/%E0%80%AF", "/%ED%A0%80", "/%F4%90%80%80", "/%C3",
                            "/%E2%82", "/%80", "/%F0%80%80%AF"}) {
    EXPECT_THAT(why_not(wrong), HasSubstr("not UTF-8")) << wrong;
  }
  EXPECT_EQ(parse_target("/%F0%9F%8F%A2%E2%82%AC")->path, "/🏢€");
}

}  // namespace
}  // namespace recald::http
