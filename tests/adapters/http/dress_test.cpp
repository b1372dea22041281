#include "adapters/http/dress.hpp"

#include <gmock/gmock.h>
#include <zlib.h>

#include "adapters/http/gzip.hpp"

namespace recald::http {
namespace {

using ::testing::IsEmpty;
using ::testing::Lt;
using ::testing::StartsWith;

std::string unpacked(std::string packed) {
  z_stream stream{};
  if (inflateInit2(&stream, 15 + 16) != Z_OK) return "";
  std::string text(1 << 20, '\0');
  stream.next_in = reinterpret_cast<Bytef*>(packed.data());
  stream.avail_in = static_cast<uInt>(packed.size());
  stream.next_out = reinterpret_cast<Bytef*>(text.data());
  stream.avail_out = static_cast<uInt>(text.size());
  const int ended = inflate(&stream, Z_FINISH);
  text.resize(stream.total_out);
  inflateEnd(&stream);
  return ended == Z_STREAM_END ? text : "not a whole gzip member";
}

std::string long_text() {
  std::string text;
  for (int i = 0; i < 2000; ++i) text += "{\"mean_kW\":" + std::to_string(i) + "}";
  return text;
}

TEST(Gzip, GivesBackWhatItPacked) {
  for (const std::string& text : {std::string{}, std::string{"a"}, long_text()}) {
    EXPECT_EQ(unpacked(gzip(text)), text);
  }
  EXPECT_THAT(gzip(long_text()).size(), Lt(long_text().size() / 3));
}

TEST(Gzip, IsSentToThoseWhoTakeIt) {
  for (const char* yes : {"gzip", "deflate, gzip;q=0.5", "GZIP", "x-gzip", "*", "*;q=0.1, br",
                          "gzip;q=0.001", "*;q=0, gzip"}) {
    EXPECT_TRUE(accepts_gzip(yes)) << yes;
  }
  for (const char* no :
       {"", "deflate", "gzip;q=0", "gzip; q=0.000", "*;q=0", "gzip;q=0, *", "gzipped"}) {
    EXPECT_FALSE(accepts_gzip(no)) << no;
  }
}

TEST(Dress, AKnownBodyIsNotSentAgain) {
  const Response first = dressed({}, json_response("{}"));
  EXPECT_EQ(first.status, 200);
  const std::string etag{first.header("etag")};
  ASSERT_THAT(etag, StartsWith("W/\""));
  Request again{.headers = {{"if-none-match", "\"other\", " + etag}}};
  const Response second = dressed(again, json_response("{}"));
  EXPECT_EQ(second.status, 304);
  EXPECT_THAT(second.body, IsEmpty());
  EXPECT_EQ(second.header("ETag"), etag);
  EXPECT_EQ(dressed(again, json_response("{ }")).status, 200);  // it has changed
}

TEST(Dress, TagsAreComparedWeakly) {
  EXPECT_TRUE(matches_etag("*", "W/\"a\""));
  EXPECT_TRUE(matches_etag("\"a\"", "W/\"a\""));
  EXPECT_TRUE(matches_etag("W/\"b\" , W/\"a\"", "W/\"a\""));
  EXPECT_FALSE(matches_etag("", "W/\"a\""));
  EXPECT_FALSE(matches_etag("\"A\"", "W/\"a\""));
}

TEST(Dress, OnlyWhatWasReadIsConfirmed) {
  const Request post{.method = Method::post, .headers = {{"if-none-match", "*"}}};
  EXPECT_EQ(dressed(post, json_response("{}")).status, 200);
  const Request get{.headers = {{"if-none-match", "*"}}};
  EXPECT_EQ(dressed(get, error_response(404, "not_found", "no")).status, 404);
}

TEST(Dress, LongBodiesArePackedForThoseWhoTakeIt) {
  const Request takes{.headers = {{"accept-encoding", "gzip"}}};
  const Response packed = dressed(takes, json_response(long_text()));
  EXPECT_EQ(packed.header("Content-Encoding"), "gzip");
  EXPECT_EQ(unpacked(packed.body), long_text());
  EXPECT_EQ(packed.header("Vary"), "Accept-Encoding");
  EXPECT_EQ(dressed(takes, json_response("{}")).body, "{}");
  EXPECT_EQ(dressed({}, json_response(long_text())).body, long_text());
}

TEST(Dress, BrowsersAreKeptFromHarm) {
  const Response response = dressed({}, json_response("{}"));
  EXPECT_THAT(std::string{response.header("Content-Security-Policy")},
              StartsWith("default-src 'self';"));
  EXPECT_EQ(response.header("X-Content-Type-Options"), "nosniff");
  EXPECT_EQ(response.header("Cache-Control"), "private, no-cache");
}

TEST(Dress, WhoAnswersMaySayHowLongItHolds) {
  Response css{.content_type = "text/css", .body = "a{}"};
  css.headers.emplace_back("Cache-Control", "max-age=3600");
  const Response response = dressed({}, css);
  EXPECT_EQ(response.header("cache-control"), "max-age=3600");
}

TEST(ErrorResponse, QuotesEvenWhatIsNoText) {
  const Response response = error_response(404, "not_found", "no \"\xFF\"", "id");
  EXPECT_EQ(response.body,
            "{\"error\":{\"code\":\"not_found\",\"message\":\"no \\\"\xEF\xBF\xBD\\\"\","
            "\"field\":\"id\"}}\n");
}

}  // namespace
}  // namespace recald::http
