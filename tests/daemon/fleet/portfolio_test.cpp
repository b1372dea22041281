#include "daemon/fleet/serve/portfolio.hpp"

#include <gtest/gtest.h>

#include <string>
#include <utility>

namespace recald::daemon {
namespace {

using std::chrono::hours;

constexpr metering::Instant kNow{std::chrono::sys_days{std::chrono::year{2026} / 3 / 10}};
const metering::Month kFebruary = std::chrono::year{2026} / 2;

record::RecordedSite site(const std::string& id, hours since_heard = hours{1}) {
  record::RecordedSite one;
  one.site.id = id;
  one.site.use = "office";
  one.site.climate = "4A";
  one.site.floor_area_m2 = 1'000.0;
  one.site.currency = "EUR";
  one.heard = kNow - since_heard;
  return one;
}

record::FleetResultRow result(const std::string& site, JobKind kind, std::string summary) {
  record::FleetResultRow row;
  row.site = site;
  row.kind = kind;
  row.month = kFebruary;
  row.accepted = true;
  row.summary = std::move(summary);
  row.files = {"report.html"};
  return row;
}

std::string calibration(double measured, double cvrmse, const std::string& money,
                        const std::string& alarms = "") {
  return R"({"outputs":[{"meter":"main","unit":"kWh/day","measured":)" + std::to_string(measured) +
         R"(,"cvrmse":)" + std::to_string(cvrmse) + R"(,"gap_money_month":)" + money +
         R"(}],"alarms":[)" + alarms + R"(],"meter_changes":[]})";
}

record::FleetJob job(const std::string& site, record::FleetJobState state) {
  record::FleetJob one;
  one.site = site;
  one.state = state;
  one.reason = "its process was killed by signal 9";
  return one;
}

TEST(Portfolio, PutsWhatIsUrgentFirstAndThenWhatCostsMost) {
  const auto portfolio = portfolio_of(
      {site("cheap"), site("silent", hours{30}), site("dear"), site("changed"), site("named")},
      {result("cheap", JobKind::calibration, calibration(100.0, 0.1, "10.0")),
       result("dear", JobKind::calibration, calibration(100.0, 0.1, "900.0")),
       result("changed", JobKind::calibration,
              calibration(100.0, 0.1, "5.0", R"({"sentence":"Steam rose by 8 %."})"))},
      {result("named", JobKind::diagnosis,
              R"({"named":[{"title":"Fouling","probability":0.4},
                           {"title":"Weekend operation","probability":0.93,"money_month":320.0}]})")},
      {}, kNow);
  std::vector<std::string> order;
  for (const PortfolioRow& row : portfolio.rows) order.push_back(row.site.site.id);
  EXPECT_EQ(order, (std::vector<std::string>{"silent", "named", "changed", "dear", "cheap"}));
  EXPECT_EQ(portfolio.rows[1].named.front().title, "Weekend operation");
  EXPECT_EQ(portfolio.rows[1].named.front().money_month, 320.0);
  EXPECT_EQ(portfolio.rows[2].alarms, (std::vector<std::string>{"Steam rose by 8 %."}));
}

TEST(Portfolio, WhoseJobFailedComesFirst) {
  const auto portfolio = portfolio_of({site("well"), site("poison")}, {}, {},
                                      {job("poison", record::FleetJobState::set_aside)}, kNow);
  ASSERT_EQ(portfolio.rows.front().site.site.id, "poison");
  ASSERT_TRUE(portfolio.rows.front().troubled);
  EXPECT_EQ(portfolio.rows.front().troubled->reason, "its process was killed by signal 9");
  EXPECT_FALSE(portfolio.rows.back().troubled);
}

TEST(Portfolio, SaysWhatReachesTheRecord) {
  const auto feed = [](std::optional<hours> since_heard, std::optional<hours> age) {
    record::RecordedSite one = site("tower");
    one.heard = since_heard ? std::optional{kNow - *since_heard} : std::nullopt;
    one.newest = age ? std::optional{kNow - *age} : std::nullopt;
    return portfolio_of({one}, {}, {}, {}, kNow).rows.front().feed;
  };
  EXPECT_EQ(feed(hours{1}, hours{1}), Feed::current);
  EXPECT_EQ(feed(hours{1}, {}), Feed::current);  // it has sent no interval yet
  EXPECT_EQ(feed(hours{1}, hours{0}), Feed::current);
  EXPECT_EQ(feed({}, {}), Feed::silent);
  EXPECT_EQ(feed(hours{25}, hours{1}), Feed::silent);
  EXPECT_EQ(feed(hours{1}, hours{25}), Feed::late);
  EXPECT_EQ(feed(hours{1}, hours{-2}), Feed::ahead);
  PortfolioRow row{.site = site("tower"), .feed = Feed::ahead};
  EXPECT_TRUE(fits(row, {.state = "ahead"}));
  EXPECT_FALSE(fits(row, {.state = "silent"}));
}

TEST(Portfolio, ComparesSitesOfAUseAndClimateByQuartiles) {
  std::vector<record::RecordedSite> sites;
  std::vector<record::FleetResultRow> results;
  for (int i = 1; i <= 5; ++i) {
    sites.push_back(site("site" + std::to_string(i)));
    results.push_back(result(sites.back().site.id, JobKind::calibration,
                             calibration(100.0 * i, 0.1 * i, "null")));
  }
  sites.push_back(site("school"));
  sites.back().site.use = "school";
  const auto portfolio = portfolio_of(sites, results, {}, {}, kNow);
  ASSERT_EQ(portfolio.groups.size(), 2u);
  const PortfolioGroup& offices = portfolio.groups.front();
  EXPECT_EQ(offices.use, "office");
  EXPECT_EQ(offices.sites, 5);
  ASSERT_TRUE(offices.energy_kWh_m2_year);
  EXPECT_NEAR(offices.energy_kWh_m2_year->q25, 0.2 * 365.25, 1e-9);
  EXPECT_NEAR(offices.energy_kWh_m2_year->q50, 0.3 * 365.25, 1e-9);
  EXPECT_NEAR(offices.worst_cvrmse->q75, 0.4, 1e-6);
  // Of one school there is nothing to compare.
  EXPECT_FALSE(portfolio.groups.back().energy_kWh_m2_year);
}

TEST(Portfolio, AFilterTakesWhatFitsAllItsWords) {
  PortfolioRow row{.site = site("tower")};
  EXPECT_TRUE(fits(row, {}));
  EXPECT_TRUE(fits(row, {.use = "office", .climate = "4A"}));
  EXPECT_FALSE(fits(row, {.use = "school"}));
  EXPECT_FALSE(fits(row, {.state = "alarm"}));
  row.alarms = {"Steam rose by 8 %."};
  EXPECT_TRUE(fits(row, {.use = "office", .state = "alarm"}));
  EXPECT_FALSE(fits(row, {.climate = "5A", .state = "alarm"}));
}

TEST(Portfolio, ASummaryThatCannotBeReadLeavesTheSiteInTheList) {
  const auto portfolio =
      portfolio_of({site("tower")}, {result("tower", JobKind::calibration, "{damaged")},
                   {result("gone", JobKind::diagnosis, "{}")}, {}, kNow);
  ASSERT_EQ(portfolio.rows.size(), 1u);
  EXPECT_EQ(portfolio.rows.front().month, kFebruary);
  EXPECT_FALSE(portfolio.rows.front().worst_cvrmse);
}

}  // namespace
}  // namespace recald::daemon
