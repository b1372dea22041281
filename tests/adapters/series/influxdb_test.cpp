/// Against a real InfluxDB 1.6: what was sent is asked back.
#include "tests/support/influxdb.hpp"

#include <gmock/gmock.h>

#include <map>
#include <memory>
#include <set>

#include "adapters/series/writing.hpp"
#include "tests/adapters/series/random_labels.hpp"
#include "tests/adapters/series/sample_points.hpp"
#include "tests/support/seed.hpp"

namespace recald::series::influxdb_test {
namespace {

using recald::testing::interval_point;
using recald::testing::this_quarter;
using std::chrono::days;
using std::chrono::minutes;
using ::testing::HasSubstr;
using ::testing::SizeIs;

/// Meter, then seconds since 1970 and value.
using Stored = std::map<std::string, std::map<std::int64_t, double>>;

/// @tparam  Whether it asks for a password.
class InfluxDbWrites : public ::testing::TestWithParam<bool> {
 protected:
  void SetUp() override {
    if (!recald::testing::InfluxDb::can_run()) {
      GTEST_SKIP() << "the Debian package influxdb is absent";
    }
    server_ = std::make_unique<recald::testing::InfluxDb>(
        recald::testing::InfluxDbOptions{.asks_for_password = GetParam()});
    server_->start();
    server_->query("CREATE DATABASE depot");
  }
  Meaning send(const std::vector<Point>& points, const std::string& database = "depot",
               const std::string& password = "a password") {
    delivery::Post to{.url = server_->write_url(database)};
    if (GetParam()) {
      to.user = "ada";
      to.password = password;
    }
    const auto answer = delivery::post(message(Protocol::influx, to, points), {});
    if (!answer) throw std::runtime_error(answer.error().message);
    return meaning_of(*answer);
  }
  [[nodiscard]] Stored stored(const std::string& database = "depot") const {
    Stored found;
    const auto answer = server_->query(
        "SELECT mean_kilowatts FROM recald_interval WHERE site = 'depot' GROUP BY *", database);
    for (const auto& series : answer) {
      auto& values = found[series["tags"].value("meter", "")];
      for (const auto& value : series["values"]) values[value[0]] = value[1];
    }
    return found;
  }

  std::unique_ptr<recald::testing::InfluxDb> server_;
};

TEST_P(InfluxDbWrites, TwoWeeksComeBackAsTheyWereSent) {
  const auto now = this_quarter();
  Stored sent;
  for (const std::string meter : {"main", "chiller-2"}) {
    std::vector<Point> points;
    for (auto start = now - days{14}; start <= now; start += minutes{15}) {
      const double mean_kW = 100.0 / 3.0 + static_cast<double>(points.size());
      points.push_back(interval_point(meter, start, mean_kW));
      sent[meter][start.time_since_epoch().count()] = mean_kW;
    }
    points.push_back(interval_point(meter, now - days{400}, 1e22));
    sent[meter][(now - days{400}).time_since_epoch().count()] = 1e22;
    EXPECT_EQ(send(points).outcome, Outcome::taken);
  }
  EXPECT_EQ(stored(), sent);

  server_->kill();
  server_->start();
  EXPECT_EQ(stored(), sent);
  EXPECT_EQ(send({interval_point("main", now, -0.1)}).outcome, Outcome::taken);
  sent["main"][now.time_since_epoch().count()] = -0.1;  // a correction
  EXPECT_EQ(stored(), sent);
}

TEST_P(InfluxDbWrites, BeyondTheRetentionAPointIsDroppedAlone) {
  server_->query("CREATE DATABASE short WITH DURATION 7d");
  const auto now = this_quarter();
  const auto part = send(
      {interval_point("main", now - days{30}, 1.0), interval_point("main", now, 2.0)}, "short");
  EXPECT_EQ(part.outcome, Outcome::partly);
  EXPECT_THAT(part.why, HasSubstr("points beyond retention policy dropped=1"));
  const Stored one{{"main", {{now.time_since_epoch().count(), 2.0}}}};
  EXPECT_EQ(stored("short"), one);
}

TEST_P(InfluxDbWrites, AMessageWaitsForItsDatabase) {
  const std::vector<Point> points{interval_point("main", this_quarter(), 1.0)};
  const auto early = send(points, "tower");
  EXPECT_EQ(early.outcome, Outcome::later);
  EXPECT_EQ(early.why, R"(answered with status 404: database not found: "tower")");
  server_->query("CREATE DATABASE tower");
  EXPECT_EQ(send(points, "tower").outcome, Outcome::taken);
  EXPECT_THAT(stored("tower"), SizeIs(1));
}

// An address without `db` is answered like a message that cannot be read.
TEST_P(InfluxDbWrites, NoPointsTellWhetherTheDestinationIsRight) {
  EXPECT_EQ(send({}).outcome, Outcome::taken);
  const auto nowhere = send({}, "");
  EXPECT_EQ(nowhere.outcome, Outcome::refused);
  EXPECT_EQ(nowhere.why, "answered with status 400: database is required");
}

TEST_P(InfluxDbWrites, AWrongPasswordIsNamed) {
  if (!GetParam()) return;
  const std::vector<Point> points{interval_point("main", this_quarter(), 1.0)};
  const auto wrong = send(points, "depot", "another");
  EXPECT_EQ(wrong.outcome, Outcome::later);
  EXPECT_EQ(wrong.why, "answered with status 401: authorization failed");
  EXPECT_THAT(stored(), SizeIs(0));
}

// But for backslashes and control characters, which line_protocol.hpp says.
TEST_P(InfluxDbWrites, AnyLabelComesBack) {
  const recald::testing::Seed seed;
  std::mt19937_64 generator{seed.value()};
  const auto now = this_quarter();
  std::vector<Point> points;
  std::set<std::string> expected;
  for (int i = 0; i < 500; ++i) {
    std::string label = recald::testing::random_label(generator);
    points.push_back(interval_point(label, now, 1.0));
    for (char& c : label) {
      if (c == '\\') c = '/';
      if ((c >= 0 && c < ' ') || c == 0x7F) c = ' ';
    }
    expected.insert(label);
  }
  ASSERT_EQ(send(points).outcome, Outcome::taken);
  std::set<std::string> found;
  for (const auto& [meter, values] : stored()) found.insert(meter);
  EXPECT_THAT(expected, SizeIs(::testing::Gt(300U)));
  EXPECT_EQ(found, expected);
}

INSTANTIATE_TEST_SUITE_P(WithAndWithoutAPassword, InfluxDbWrites, ::testing::Bool(),
                         [](const auto& each) { return each.param ? "password" : "open"; });

}  // namespace
}  // namespace recald::series::influxdb_test
