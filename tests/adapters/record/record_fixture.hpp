/// A record of its own for each test, on a server that they share, and what a gateway would send.
#pragma once

#include <gtest/gtest.h>

#include <memory>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "adapters/record/ingest.hpp"
#include "adapters/record/schema.hpp"
#include "adapters/record/sites.hpp"
#include "tests/support/postgres_server.hpp"

namespace recald::record {

inline const metering::Instant kNow{std::chrono::sys_days{std::chrono::year{2024} / 5 / 1} +
                                    std::chrono::hours{6}};
inline constexpr std::chrono::seconds kQuarter{900};
inline const metering::Instant kMarch = std::chrono::sys_days{std::chrono::year{2024} / 3 / 1};

inline metering::Month month_of(int year, unsigned month) {
  return std::chrono::year{year} / std::chrono::month{month};
}

inline OutboxEntry interval_entry(std::int64_t number, const std::string& meter,
                                  metering::Instant start, double mean_kW, int revision = 0) {
  return {.number = number,
          .meter = meter,
          .interval = kQuarter,
          .stored = StoredInterval{{.meter = 7, .start = start, .mean_kW = mean_kW}, revision}};
}

inline OutboxEntry month_entry(std::int64_t number, const std::string& meter, metering::Month month,
                               double daily_average_kWh) {
  metering::MonthlyFigure figure{
      .month = month,
      .daily_average_kWh = daily_average_kWh,
      .daily_average_variance_kWh2 = 0.1,
      .peak = metering::PeakDemand{.kW = 12.3, .start = kMarch, .could_be_exceeded = true},
      .peak_window = kQuarter,
      .coverage = 0.99,
      .filled_share = 0.01,
      .slots_by_validity = {2950, 1, 20, 4, 1},
      .slots = 2976,
      .usable = true,
      .unusable_because = ""};
  return {.number = number,
          .meter = meter,
          .interval = kQuarter,
          .stored = StoredMonth{figure, kNow + std::chrono::seconds{number}, "2024a"}};
}

/// `count` quarters of an hour of one meter, numbered from `after` + 1.
inline RecordBatch intervals(std::int64_t after, int count, std::int64_t outbox = 11) {
  RecordBatch batch{.outbox = outbox, .after = {.entries = after}};
  for (int i = 1; i <= count; ++i) {
    const std::int64_t number = after + i;
    batch.entries.push_back(
        interval_entry(number, "steam", kMarch + number * kQuarter, 0.1 * double(number)));
  }
  return batch;
}

/// What ends the past of an outbox.
inline RecordBatch end_of_history(std::int64_t outbox) {
  return {.outbox = -outbox,
          .is_first = true,
          .entries = {{.number = kHistorySent,
                       .meter = "",
                       .interval = std::chrono::seconds{1},
                       .stored = {}}}};
}

inline SiteDescription described(const std::string& id) {
  return {.id = id,
          .name = "Tower",
          .use = "office",
          .climate = "4A",
          .latitude_deg = 40.7,
          .floor_area_m2 = 12'000.0,
          .currency = "USD",
          .outputs = {"steam", "power"},
          .site_file = "site.toml",
          .files = {{"site.toml", "id = 1"}, {"weather/city.epw", std::string{"a\0b\xff", 4}}},
          .calibrate_from = month_of(2024, 2)};
}

class Record : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    if (!testing::PostgresServer::can_run()) return;
    server_ = new testing::PostgresServer;
    server_->start();
  }
  static void TearDownTestSuite() { delete server_; }

  void SetUp() override {
    if (server_ == nullptr) GTEST_SKIP() << "no postgresql-15";
    url_ = server_->new_database();
    connection_ = open();
    const auto made = make_schema(*connection_);
    ASSERT_TRUE(made) << made.error().message;
    EXPECT_EQ(*made, "");
    ASSERT_TRUE(put_site(*connection_, described("tower"), "ann"));
  }

  [[nodiscard]] std::unique_ptr<postgres::Connection> open() const {
    auto opened = postgres::Connection::open(url_, "");
    if (!opened) throw std::runtime_error(opened.error().message);
    return std::move(*opened);
  }
  /// As a user who has one role and nothing else; `leave` removes it again.
  [[nodiscard]] std::unique_ptr<postgres::Connection> open_as(const std::string& role,
                                                              const std::string& user) const {
    (void)ask("CREATE USER " + user + " IN ROLE " + role);
    auto opened = postgres::Connection::open("postgresql://" + user +
                                                 "@127.0.0.1:" + std::to_string(server_->port()) +
                                                 url_.substr(url_.rfind('/')),
                                             "");
    if (!opened) throw std::runtime_error(opened.error().message);
    return std::move(*opened);
  }
  void leave(const std::string& user) const { (void)ask("DROP USER " + user); }
  /// What another program reads.
  [[nodiscard]] std::string ask(const std::string& statement) const {
    return server_->ask(statement, url_.substr(url_.rfind('/') + 1));
  }
  [[nodiscard]] Result<Watermark> send(const RecordBatch& batch,
                                       const std::string& site = "tower") const {
    return take(*connection_, site, batch, kNow);
  }

  inline static testing::PostgresServer* server_ = nullptr;
  std::string url_;
  std::unique_ptr<postgres::Connection> connection_;
};

}  // namespace recald::record
