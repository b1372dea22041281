#include "adapters/http/url.hpp"

#include <gmock/gmock.h>

namespace recald::http {
namespace {

using ::testing::HasSubstr;

TEST(Url, HostPortAndPath) {
  const auto url = parse_url("http://tower:8080/api/v1/sites?a=b:c");
  ASSERT_TRUE(url.has_value());
  EXPECT_FALSE(url->is_tls);
  EXPECT_EQ(url->host, "tower");
  EXPECT_EQ(url->port, 8080);
  EXPECT_EQ(url->path, "/api/v1/sites?a=b:c");
  EXPECT_EQ(url->text(), "http://tower:8080/api/v1/sites?a=b:c");
}

TEST(Url, WhatIsUsualMayBeLeftOut) {
  EXPECT_EQ(parse_url("http://tower")->text(), "http://tower:80/");
  EXPECT_EQ(parse_url("https://tower/")->text(), "https://tower:443/");
}

TEST(Url, AnIpv6AddressStandsInBrackets) {
  const auto url = parse_url("https://[::1]:8443");
  ASSERT_TRUE(url.has_value());
  EXPECT_EQ(url->host, "::1");
  EXPECT_EQ(url->port, 8443);
  EXPECT_EQ(url->authority(), "[::1]:8443");
}

TEST(Url, WhatIsWrongIsSaid) {
  const auto why_not = [](std::string_view text) {
    const auto url = parse_url(text);
    return url ? "it was taken" : url.error().message;
  };
  EXPECT_THAT(why_not("tower:8080"), HasSubstr("neither http:// nor https://"));
  EXPECT_THAT(why_not("http://"), HasSubstr("names no host"));
  EXPECT_THAT(why_not("http://:80"), HasSubstr("names no host"));
  EXPECT_THAT(why_not("http://a:0"), HasSubstr("1 to 65535"));
  EXPECT_THAT(why_not("http://a:65536"), HasSubstr("1 to 65535"));
  EXPECT_THAT(why_not("http://a:8x"), HasSubstr("1 to 65535"));
  EXPECT_THAT(why_not("http://[::1"), HasSubstr("not closed"));
  EXPECT_THAT(why_not("http://[::1]x:80"), HasSubstr("between ']' and the port"));
  EXPECT_THAT(why_not("https://[[4]/"), HasSubstr("its host has a bracket"));
  EXPECT_THAT(why_not("http://a[:80"), HasSubstr("its host has a bracket"));
  EXPECT_THAT(why_not("http://a/\r\nb"), HasSubstr("a character that no address has"));
  EXPECT_THAT(why_not("http://a/\x1B[2J"), HasSubstr("'http://a/\\x1B[2J'"));
  EXPECT_THAT(why_not("http://me@a/"), HasSubstr("a character that no address has"));
}

}  // namespace
}  // namespace recald::http
