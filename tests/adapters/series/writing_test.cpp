#include "adapters/series/writing.hpp"

#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "adapters/series/remote_write.hpp"
#include "tests/adapters/series/sample_points.hpp"

namespace recald::series::writing_test {
namespace {

using recald::testing::interval_point;
using ::testing::ElementsAre;
using ::testing::EndsWith;
using ::testing::HasSubstr;

Outcome outcome(long status, const std::string& body = "") {
  return meaning_of({.status = status, .body = body}).outcome;
}

TEST(Message, SaysWhatTheProtocolIs) {
  const std::vector<Point> points{interval_point("main", {}, 1.0)};
  const delivery::Post to{.url = "http://a/b",
                          .token = "t",
                          .user = {},
                          .password = {},
                          .trusted_certificate = {},
                          .content_type = {},
                          .headers = {"X-Scope-OrgID: tower"},
                          .body = {}};
  const auto prometheus = message(Protocol::remote_write, to, points);
  EXPECT_EQ(prometheus.url, to.url);
  EXPECT_EQ(prometheus.token, to.token);
  EXPECT_EQ(prometheus.content_type, "application/x-protobuf");
  EXPECT_THAT(prometheus.headers, ElementsAre("X-Scope-OrgID: tower", "Content-Encoding: snappy",
                                              "X-Prometheus-Remote-Write-Version: 0.1.0"));
  EXPECT_EQ(prometheus.body, remote_write_body(points));
  const auto influx = message(Protocol::influx, to, points);
  EXPECT_EQ(influx.content_type, "text/plain; charset=utf-8");
  EXPECT_THAT(influx.headers, ElementsAre("X-Scope-OrgID: tower"));
  EXPECT_EQ(influx.body, "recald_interval,site=depot,meter=main mean_kilowatts=1 0\n");
}

TEST(MeaningOf, AnAnswerIsWhatTheProtocolsSay) {
  for (const long taken : {200, 202, 204}) EXPECT_EQ(outcome(taken), Outcome::taken) << taken;
  for (const long refused : {400, 413, 422}) EXPECT_EQ(outcome(refused), Outcome::refused);
  // Somebody has to change the address, a password or a setting, or only to wait.
  for (const long later : {301, 302, 401, 403, 404, 405, 408, 415, 429, 500, 502, 503, 504}) {
    EXPECT_EQ(outcome(later), Outcome::later) << later;
  }
  EXPECT_EQ(outcome(400, R"({"error":"partial write: field type conflict: … dropped=1"})"),
            Outcome::partly);
  EXPECT_EQ(outcome(500, "too old sample\n"), Outcome::refused);
}

TEST(MeaningOf, AnAnswerHasAReason) {
  EXPECT_EQ(meaning_of({.status = 204, .body = {}}).why, "");
  EXPECT_EQ(meaning_of({.status = 503, .body = {}}).why, "answered with status 503");
  EXPECT_EQ(meaning_of({.status = 404, .body = R"({"error":"database not found: \"x\""})"}).why,
            R"(answered with status 404: database not found: "x")");
  EXPECT_EQ(meaning_of({.status = 413, .body = "too large\r\nby far\n"}).why,
            "answered with status 413: too large");
  EXPECT_THAT(meaning_of({.status = 400, .body = "out of bounds\n"}).why,
              AllOf(HasSubstr("400: out of bounds; "), EndsWith("out_of_order_time_window")));
}

TEST(MeaningOf, AnAnswerMayAskForTime) {
  const auto busy =
      meaning_of({.status = 429, .body = {}, .retry_after = std::chrono::seconds{90}});
  EXPECT_EQ(busy.outcome, Outcome::later);
  EXPECT_EQ(busy.wait, std::chrono::seconds{90});
}

// The body is cut after some bytes, within a character; Latin-1 comes from old programs.
TEST(MeaningOf, ReasonsAreUtf8) {
  for (const char* cut : {"Geb\xC3", "Geb\xE4ude"}) {
    const nlohmann::json why = meaning_of({.status = 500, .body = cut}).why;
    EXPECT_THAT(why.dump(), HasSubstr("Geb\xEF\xBF\xBD"));  // U+FFFD
  }
}

}  // namespace
}  // namespace recald::series::writing_test
