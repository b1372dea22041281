/// Against a real Prometheus: what was sent is asked back.
#include "tests/support/prometheus.hpp"

#include <gmock/gmock.h>

#include <map>
#include <memory>
#include <set>

#include "adapters/series/writing.hpp"
#include "tests/adapters/series/random_labels.hpp"
#include "tests/adapters/series/sample_points.hpp"
#include "tests/support/seed.hpp"

namespace recald::series::prometheus_test {
namespace {

using recald::testing::interval_point;
using recald::testing::this_quarter;
using std::chrono::days;
using std::chrono::hours;
using std::chrono::minutes;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;

/// Metric and meter, then seconds since 1970 and value.
using Stored = std::map<std::pair<std::string, std::string>, std::map<std::int64_t, double>>;

class PrometheusWrites : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!recald::testing::Prometheus::can_run()) {
      GTEST_SKIP() << "the Debian package prometheus is absent";
    }
  }
  void begin(const recald::testing::PrometheusOptions& options) {
    server_ = std::make_unique<recald::testing::Prometheus>(options);
    server_->start();
  }
  Meaning send(const std::vector<Point>& points) {
    const auto answer =
        delivery::post(message(Protocol::remote_write, {.url = server_->write_url()}, points), {});
    if (!answer) throw std::runtime_error(answer.error().message);
    return meaning_of(*answer);
  }
  [[nodiscard]] Stored stored() const {
    Stored found;
    for (const auto& series : server_->query("{site=\"depot\"}[1y]")) {
      const auto& labels = series["metric"];
      auto& values = found[{labels["__name__"], labels["meter"]}];
      for (const auto& value : series["values"]) {
        values[value[0]] = std::stod(value[1].get<std::string>());
      }
    }
    return found;
  }

  /// What is stored, asked for until it is what is expected, for at most ten seconds: the first
  /// day-old samples make Prometheus compact at once, and a query beside that may miss a sample.
  [[nodiscard]] Stored settled(const Stored& expected) const {
    Stored found;
    recald::testing::eventually([&] { return (found = stored()) == expected; });
    return found;
  }

  std::unique_ptr<recald::testing::Prometheus> server_;
};

// The outbox of a gateway whose Prometheus was away for two weeks, meter after meter.
TEST_F(PrometheusWrites, TwoWeeksComeBackAsTheyWereSent) {
  begin({.out_of_order_window = "90d"});
  const auto now = this_quarter();
  Stored sent;
  for (const std::string meter : {"main", "chiller-2"}) {
    std::vector<Point> points;
    for (auto start = now - days{14}; start <= now; start += minutes{15}) {
      const double mean_kW = 100.0 / 3.0 + static_cast<double>(points.size());
      points.push_back(interval_point(meter, start, mean_kW));
      points.back().fields.push_back({"fill_ratio", 1.0 / mean_kW});
      const auto second = start.time_since_epoch().count();
      sent[{"recald_interval_mean_kilowatts", meter}][second] = mean_kW;
      sent[{"recald_interval_fill_ratio", meter}][second] = 1.0 / mean_kW;
    }
    EXPECT_EQ(send(points).outcome, Outcome::taken);
    Point month = interval_point(meter, now - days{45}, 1.5e6);
    month.measurement = "recald_month";
    EXPECT_EQ(send({month}).outcome, Outcome::taken);
    sent[{"recald_month_mean_kilowatts", meter}][month.time.time_since_epoch().count()] = 1.5e6;
  }
  EXPECT_EQ(settled(sent), sent);

  server_->kill();
  server_->start();
  EXPECT_EQ(settled(sent), sent);
  EXPECT_EQ(send({interval_point("main", now, 100.0 / 3.0 + 14 * 96)}).outcome, Outcome::taken);
  EXPECT_EQ(settled(sent), sent);  // once more, and nothing changed
}

// As Prometheus comes: of no use to an outbox that has fallen behind.
TEST_F(PrometheusWrites, WithoutAWindowAnOldSampleIsRefusedWithAllThatCameWithIt) {
  begin({});
  const auto now = this_quarter();
  EXPECT_EQ(send({interval_point("main", now - minutes{15}, 1.0)}).outcome, Outcome::taken);
  const auto old = send({interval_point("chiller-2", now - days{14}, 2.0),  //
                         interval_point("main", now, 3.0)});
  EXPECT_EQ(old.outcome, Outcome::refused);
  EXPECT_THAT(old.why, HasSubstr("status 400: out of bounds; Prometheus takes older samples"));
  const auto before = send({interval_point("main", now - minutes{30}, 4.0)});
  EXPECT_EQ(before.outcome, Outcome::refused);
  EXPECT_THAT(before.why, HasSubstr("status 400: out of order sample"));
  const Stored only{{{"recald_interval_mean_kilowatts", "main"},
                     {{(now - minutes{15}).time_since_epoch().count(), 1.0}}}};
  EXPECT_EQ(stored(), only);
  EXPECT_EQ(send({interval_point("main", now, 3.0)}).outcome, Outcome::taken);
}

TEST_F(PrometheusWrites, BeforeTheWindowASampleIsRefused) {
  begin({.out_of_order_window = "1d"});
  const auto now = this_quarter();
  EXPECT_EQ(send({interval_point("main", now, 1.0)}).outcome, Outcome::taken);
  EXPECT_EQ(send({interval_point("main", now - hours{20}, 2.0)}).outcome, Outcome::taken);
  const auto old = send({interval_point("main", now - days{14}, 3.0)});
  EXPECT_EQ(old.outcome, Outcome::refused);  // for all that it answers with 500
  EXPECT_THAT(old.why, HasSubstr("too old sample"));
}

// A correction is refused, or taken without a word and not stored.
TEST_F(PrometheusWrites, ACorrectionIsNotReliable) {
  begin({.out_of_order_window = "1d"});
  const auto now = this_quarter();
  const auto before = now - minutes{15};
  EXPECT_EQ(send({interval_point("main", now, 2.0)}).outcome, Outcome::taken);
  const auto newest = send({interval_point("main", now, 20.0)});
  EXPECT_EQ(newest.outcome, Outcome::refused);
  EXPECT_THAT(newest.why, HasSubstr("duplicate sample for timestamp"));
  EXPECT_EQ(send({interval_point("main", before, 1.0)}).outcome, Outcome::taken);
  EXPECT_EQ(send({interval_point("main", before, 10.0)}).outcome, Outcome::taken);
  const Stored both{
      {{"recald_interval_mean_kilowatts", "main"},
       {{before.time_since_epoch().count(), 1.0}, {now.time_since_epoch().count(), 2.0}}}};
  EXPECT_EQ(stored(), both);
}

TEST_F(PrometheusWrites, NoPointsTellWhetherTheDestinationIsRight) {
  begin({});
  EXPECT_EQ(send({}).outcome, Outcome::taken);
  EXPECT_THAT(stored(), IsEmpty());
  begin({.receives = false});
  const auto off = send({});
  EXPECT_EQ(off.outcome, Outcome::later);
  EXPECT_THAT(off.why, HasSubstr("remote write receiver needs to be enabled"));
}

TEST_F(PrometheusWrites, AnyLabelComesBack) {
  begin({});
  const recald::testing::Seed seed;
  std::mt19937_64 generator{seed.value()};
  const auto now = this_quarter();
  std::vector<Point> points;
  std::set<std::string> sent;
  for (int i = 0; i < 500; ++i) {
    points.push_back(interval_point(recald::testing::random_label(generator), now, 1.0));
    sent.insert(points.back().labels[1].second);
  }
  ASSERT_EQ(send(points).outcome, Outcome::taken);
  std::set<std::string> found;
  for (const auto& [series, values] : stored()) found.insert(series.second);
  EXPECT_THAT(sent, SizeIs(::testing::Gt(300U)));
  EXPECT_EQ(found, sent);
}

}  // namespace
}  // namespace recald::series::prometheus_test
