/// The weather of a live site: from a sensor that is polled, from one that sends, and from a file
/// that grows; what a calibration makes of it, and what it says and does when some is missing.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "adapters/csv/weather_csv.hpp"
#include "adapters/sqlite/sqlite_store.hpp"
#include "daemon/gateway/run/site_jobs.hpp"
#include "daemon/gateway/serve/api/served.hpp"
#include "daemon/site/replay/sensor_weather.hpp"
#include "daemon/site/replay/site_weather.hpp"
#include "daemon/site/replay/stored_readings.hpp"
#include "tests/daemon/command_line.hpp"
#include "tests/daemon/depot_year.hpp"
#include "tests/daemon/gateway/weather_station.hpp"
#include "tests/daemon/short_chains.hpp"
#include "tests/support/virtual_worker.hpp"

namespace recald::daemon::live_weather_test {
namespace {

using metering::Instant;
using Json = nlohmann::json;
using recald::testing::edited;
using recald::testing::read_text;
using recald::testing::write_text;
using std::chrono::days;
using std::chrono::hours;
using std::chrono::minutes;
using std::chrono::year;
using ::testing::AllOf;
using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::SizeIs;

/// 2025 in Zurich: clocks of before 2024 are not believed.
constexpr Instant kBegin = std::chrono::sys_days{year{2024} / 12 / 31} + hours{23};
constexpr Instant kNovember = std::chrono::sys_days{year{2025} / 10 / 31} + hours{23};
constexpr Instant kDecember = std::chrono::sys_days{year{2025} / 11 / 30} + hours{23};
constexpr Instant kNow = std::chrono::sys_days{year{2025} / 12 / 5};

constexpr const char* kSender =
    "\n[[meter]]\nid = \"roof\"\nrole = \"weather\"\nsource = \"http\"\ninterval = \"1h\"\n";

/// The depot, whose meters send, with a store that has their year; its weather is known.
class LiveWeather : public ::testing::Test {
 protected:
  LiveWeather() {
    recald::testing::write_depot_year(folder_.path(), recald::testing::sample_site(),
                                      recald::testing::kDepotYear_h, kBegin);
    truth_ = csv::read_weather(folder_ / "weather.csv", {.values = weather::RecordedValues::mean})
                 .value()
                 .series;
    std::string history = read_text(folder_ / "readings.csv");
    for (auto at = history.find(",heat,"); at != std::string::npos;
         at = history.find(",heat,", at + 1)) {
      history.replace(at, 6, ",district_heat,");
    }
    write_text(folder_ / "history.csv", history);
  }

  /// @param weather  In the place of the file. @param more  At its end.
  void describe(const std::string& weather, const std::string& more) {
    std::string text = recald::testing::sample_site();
    text = edited(text, "file = \"readings.csv\"\nrated_kW = 400",
                  "source = \"http\"\nrated_kW = 400\ninterval = \"1h\"");
    text = edited(text, "file = \"readings.csv\"\nname_in_file = \"heat\"",
                  "source = \"http\"\nrated_kW = 900\ninterval = \"1h\"");
    text = edited(text, "[weather]\nfile = \"weather.csv\"\nvalues = \"mean\"\n", weather);
    write_text(folder_ / "live.toml", text + more + "\n[http]\n[recalibration]\nmonths = 6\n");
    auto loaded = load_site(folder_ / "live.toml");
    ASSERT_TRUE(loaded.has_value()) << loaded.error().front();
    site_ = std::move(*loaded);
    const auto imported =
        testing::run({"import", (folder_ / "live.toml").string(),
                      (folder_ / "history.csv").string(), "--reason", "the old system"});
    ASSERT_EQ(imported.exit_code, 0) << imported.err;
    store_.emplace(sqlite::SqliteStore::open(folder_ / "live.db").value());
    // A month of a gateway in seconds: what a power cut would leave is tested elsewhere.
    ASSERT_TRUE(store_->database().execute("PRAGMA synchronous=OFF").has_value());
  }

  /// The weather file until then.
  void cut_file(Instant end) {
    if (whole_file_.empty()) whole_file_ = read_text(folder_ / "weather.csv");
    const auto at = whole_file_.find("\n" + metering::to_string(end));
    ASSERT_NE(at, std::string::npos);
    write_text(folder_ / "weather.csv", whole_file_.substr(0, at + 1));
  }

  /// What a calibration gives on the latest closed months.
  Json calibrated(Instant now = kNow) {
    JobWatch watch;
    const auto outcome =
        make_site_work(share({site_, calendar_}), testing::short_chains())({}, now, watch);
    EXPECT_TRUE(outcome.has_value()) << outcome.error().message;
    EXPECT_FALSE(outcome->failed) << outcome->message;
    said_ = outcome->message;
    return Json::parse(outcome->result.document);
  }

  recald::testing::TemporaryFolder folder_;
  metering::LocalCalendar calendar_ = metering::LocalCalendar::open("Europe/Zurich").value();
  weather::WeatherSeries truth_;
  std::string whole_file_;
  SiteConfig site_;
  std::optional<sqlite::SqliteStore> store_;
  std::string said_;
};

std::string last_month(const Json& result) { return result["months"].back()["month"]; }

TEST_F(LiveWeather, CheckExplainsASensor) {
  const auto checked = [&] { return testing::run({"check", (folder_ / "live.toml").string()}); };
  describe("[weather]\nfile = \"weather.csv\"\nvalues = \"mean\"\n", kSender);
  const auto sender = checked();
  EXPECT_EQ(sender.exit_code, 0) << sender.err;
  EXPECT_THAT(sender.out, AllOf(HasSubstr("meter roof             weather        pushed, interval "
                                          "1 h; units degC (dry_bulb_C), %"),
                                HasSubstr("weather.csv (start-stamped")));
  const std::string text = read_text(folder_ / "live.toml");
  write_text(folder_ / "live.toml", edited(text, "\n[http]\n", "\n"));
  EXPECT_THAT(checked().err, HasSubstr("no [http] to send its readings to"));

  // A station without a pyranometer, and no file that has the sun.
  std::string polled = edited(text, "[weather]\nfile = \"weather.csv\"\nvalues = \"mean\"\n", "");
  polled = edited(polled, "role = \"weather\"\nsource = \"http\"",
                  "role = \"weather\"\nsource = \"modbus\"\nbus = \"plant\"\nunit = 3\n"
                  "map = \"sunspec-weather\"");
  write_text(folder_ / "live.toml",
             polled + "\n[bus.plant]\ntype = \"tcp\"\nhost = \"127.0.0.1\"\n");
  const auto station = checked();
  EXPECT_EQ(station.exit_code, 0);
  EXPECT_THAT(station.out, HasSubstr("unit 3 on bus 'plant', SunSpec weather station, model 307: "
                                     "dry_bulb_C, rel_humidity_pct, wind_speed_m_s, wind_dir_deg, "
                                     "every 1 min"));
  EXPECT_THAT(station.err, HasSubstr("Sun is not measured: it is assumed"));
}

/// A gateway that polls the station from then on.
class Polling : public testing::GatewayRig {
 public:
  Polling(Store& store, recald::testing::VirtualLoop& loop, Instant from,
          const weather::WeatherSeries& truth)
      : GatewayRig{store, loop, from} {
    clock_->is_synchronised = [] { return true; };  // the history of the meters is ahead of it
    devices_[3].registers = [&truth, from](std::chrono::milliseconds t) {
      const auto* const hour = truth.find(from + std::chrono::floor<std::chrono::seconds>(t));
      return testing::station_registers(hour == nullptr ? weather::WeatherHour{} : *hour);
    };
  }
};

TEST_F(LiveWeather, ASensorsMonthIsCalibratedOn) {
  cut_file(kNovember);
  write_text(folder_ / "station.toml", testing::kStationMap);
  describe("[weather]\nfile = \"weather.csv\"\nvalues = \"mean\"\n",
           "\n[bus.plant]\ntype = \"tcp\"\nhost = \"unused\"\n" +
               testing::station("interval = \"15m\"\n"));
  {
    recald::testing::VirtualLoop loop{kNovember};
    Polling polling{*store_, loop, kNovember, truth_};
    polling.begin(site_);
    loop.run_for(kDecember - kNovember + minutes{5});
  }
  const Json result = calibrated();
  EXPECT_EQ(last_month(result), "2025-11");
  const Json& november = result["weather"].back();
  EXPECT_EQ(november["month"], "2025-11");
  EXPECT_NEAR(november["known"].get<double>(), 1.0, 1e-9);
  EXPECT_NEAR(november["from"]["sensor 'roof'"].get<double>(), 1.0, 1e-9);
  EXPECT_NEAR(result["weather"][0]["from"]["weather.csv"].get<double>(), 1.0, 1e-9);
  EXPECT_THAT(
      result["warnings"].get<std::vector<std::string>>(),
      Contains("Weather: 2025-06 to 2025-10 from weather.csv; 2025-11 from sensor 'roof'."));
  EXPECT_EQ(said_, "");

  // Hour by hour it is the weather that was.
  const auto live = open_sensors(site_).value();
  const metering::Month month{year{2025} / 11};
  const auto read = load_weather(site_, calendar_, {month, month}, live.get());
  ASSERT_TRUE(read.has_value()) << read.error().message;
  for (Instant t = kNovember; t < kDecember; t += hours{1}) {
    const weather::WeatherHour& was = *truth_.find(t);
    const weather::WeatherHour& is = *read->filled.series.find(t);
    // Registers hold tenths, and a minute at each change of hour lies between two values.
    ASSERT_NEAR(is.dry_bulb_C, was.dry_bulb_C, 0.1) << metering::to_string(t);
    ASSERT_NEAR(is.rel_humidity_pct, was.rel_humidity_pct, 0.1);
    ASSERT_NEAR(is.ghi_W_m2, was.ghi_W_m2, 3.0);
    ASSERT_NEAR(std::remainder(is.wind_dir_deg - was.wind_dir_deg, 360.0), 0.0, 0.3);
  }
}

// Other readings are other data, although no file has changed.
TEST_F(LiveWeather, TheDataRevisionIsThatOfTheWeatherToo) {
  describe("[weather]\nfile = \"weather.csv\"\nvalues = \"mean\"\n", kSender);
  const auto revision = [&] {
    OpenSite site{site_, calendar_};
    site.config.period.reset();
    return load_modelled_site(std::move(site), kNow).value().facts.data_revision;
  };
  const std::string before = revision();
  EXPECT_EQ(revision(), before);
  const std::uint32_t roof = store_->meter_number("roof.dry_bulb_C", hours{1}).value();
  ASSERT_TRUE(store_->commit({.intervals = {{{.meter = roof, .start = kNovember, .mean_kW = 3.5}}}})
                  .has_value());
  EXPECT_NE(revision(), before);
}

/// A gateway that is sent the weather, with the jobs of a daemon.
class Sent : public LiveWeather {
 protected:
  class Receiving : public testing::GatewayRig {
   public:
    using GatewayRig::GatewayRig;
    Gateway& gateway() { return *gateway_; }
  };

  void begin() {
    rig_.emplace(*store_, loop_, kNow);
    rig_->begin(site_);
    jobs_.emplace(JobRunner::Ports{loop_, *store_, worker_},
                  make_site_work(share({site_, calendar_}), testing::short_chains()),
                  [this](const StoredJob& job) {
                    if (job.ended) ended_.push_back(job);
                  });
    wait_.emplace(WeatherWait::Ports{loop_, *store_, looker_},
                  make_weather_check(share({site_, calendar_})), [this] { ask("weather"); });
    wait_->start();
  }
  void ask(const char* by) { ASSERT_TRUE(jobs_->ask(JobKind::calibration, by).has_value()); }
  Json result_of(const StoredJob& job) {
    return Json::parse(store_->job(job.number).value().value().result.document);
  }

  /// As a weather service does, an hour of a quantity after the other.
  void send(Instant from, Instant to) {
    const Served served{
        .site = site_,
        .calendar = calendar_,
        .store = *store_,
        .status = [this] { return rig_->gateway().status(); },
        .meter_status = [this](const auto& id) { return rig_->gateway().meter_status(id); },
        .now = [this] { return loop_.now().instant(); },
        .take_readings =
            [this](const std::string& meter, auto readings, const auto& put_right) {
              return rig_->gateway().take_pushed(meter, std::move(readings), put_right);
            }};
    for (const weather::SensorQuantity& quantity : weather::kSensorQuantities) {
      Json readings = Json::array();
      for (Instant t = from; t < to; t += hours{1}) {
        readings.push_back(
            {{"time", metering::to_string(t)}, {"value", truth_.find(t)->*quantity.member}});
      }
      const Json body{{"meter", "roof"}, {"unit", quantity.unit}, {"readings", readings}};
      const http::Response response = answer(
          served, {.method = http::Method::post, .path = "/api/v1/readings", .body = body.dump()});
      ASSERT_EQ(response.status, 200) << response.body;
    }
  }

  recald::testing::VirtualLoop loop_{kNow};
  recald::testing::VirtualWorker worker_{loop_, minutes{1}};
  recald::testing::VirtualWorker looker_{loop_, minutes{1}};
  std::optional<Receiving> rig_;
  std::optional<JobRunner> jobs_;
  std::optional<WeatherWait> wait_;
  std::vector<StoredJob> ended_;
};

TEST_F(Sent, WeatherThatWasSentIsCalibratedOn) {
  cut_file(kNovember);
  describe("[weather]\nfile = \"weather.csv\"\nvalues = \"mean\"\n", kSender);
  begin();
  send(kNovember, kDecember);
  const Json result = calibrated();
  EXPECT_EQ(last_month(result), "2025-11");
  EXPECT_NEAR(result["weather"].back()["from"]["sensor 'roof'"].get<double>(), 1.0, 1e-9);

  // What the whole file gives, it gives.
  write_text(folder_ / "weather.csv", whole_file_);
  site_.sensors.clear();
  const Json from_file = calibrated();
  EXPECT_EQ(from_file["parameters"], result["parameters"]);
  EXPECT_EQ(from_file["months"], result["months"]);
}

// The month has closed and the file lags behind: the calibration goes without it and says so; when
// the rest has come, it is made again.
TEST_F(Sent, AFileThatGrowsIsTakenUp) {
  cut_file(kNovember + days{10});
  describe("[weather]\nfile = \"weather.csv\"\nvalues = \"mean\"\n", "");
  begin();
  ask("month");
  loop_.run_for(hours{5});
  ASSERT_THAT(ended_, SizeIs(1));
  EXPECT_EQ(last_month(result_of(ended_[0])), "2025-10");
  EXPECT_EQ(ended_[0].message,
            "weather is incomplete in 2025-11 (33 %); recald calibrates again when more arrives");
  EXPECT_THAT(result_of(ended_[0])["warnings"].get<std::vector<std::string>>(),
              Contains("November 2025 is left out: only 33 % of its outdoor temperature was "
                       "measured. weather.csv ends at 2025-11-10T23:00:00Z."));
  cut_file(kNovember + days{14});  // not half of it yet
  loop_.run_for(hours{3});
  EXPECT_THAT(ended_, SizeIs(1));
  write_text(folder_ / "weather.csv", whole_file_);
  loop_.run_for(hours{3});
  ASSERT_THAT(ended_, SizeIs(2));
  EXPECT_EQ(ended_[1].asked_by, "weather");
  EXPECT_EQ(last_month(result_of(ended_[1])), "2025-11");
  EXPECT_EQ(ended_[1].message, "");
  loop_.run_for(days{2});
  EXPECT_THAT(ended_, SizeIs(2));
}

// Silent for a week: typical hours stand in, and it is said from when to when. For three: the month
// is left out until somebody sends what was missing.
TEST_F(Sent, ASilentSensorIsSaidFromWhenToWhen) {
  describe("", kSender);
  begin();
  const Instant june = calendar_.month_span(year{2025} / 6).begin;
  const Instant october = calendar_.month_span(year{2025} / 10).begin;
  send(june, october + days{3});
  send(october + days{10}, kNovember + days{5});
  send(kNovember + days{26}, kDecember);
  ask("month");
  loop_.run_for(hours{2});
  ASSERT_THAT(ended_, SizeIs(1));
  const Json first = result_of(ended_[0]);
  EXPECT_EQ(last_month(first), "2025-10");
  EXPECT_THAT(
      first["warnings"].get<std::vector<std::string>>(),
      AllOf(Contains("October 2025 has gaps in its weather: only 77 % of its outdoor temperature "
                     "was measured. The rest is typical of the month. Sensor 'roof' was silent "
                     "from 2025-10-03T22:00:00Z to 2025-10-10T22:00:00Z (dry_bulb_C)."),
            Contains("November 2025 is left out: only 30 % of its outdoor temperature was "
                     "measured. Sensor 'roof' was silent from 2025-11-05T23:00:00Z to "
                     "2025-11-26T23:00:00Z "
                     "(dry_bulb_C).")));
  EXPECT_NEAR(first["weather"][4]["from"]["typical"].get<double>(), 7.0 * 24.0 / 745.0, 1e-9);
  EXPECT_THAT(ended_[0].message, HasSubstr("2025-10 (77 %), 2025-11 (30 %)"));
  send(kNovember + days{5}, kNovember + days{26});
  loop_.run_for(hours{2});
  ASSERT_THAT(ended_, SizeIs(2));
  EXPECT_EQ(last_month(result_of(ended_[1])), "2025-11");
  EXPECT_THAT(ended_[1].message, HasSubstr("weather is incomplete in 2025-10 (77 %);"));
}

// A sensor that nobody has connected yet: there is no weather at all. The calibration fails, and is
// made when there is.
TEST_F(Sent, WithoutAnyWeatherItFailsAndIsMadeWhenItComes) {
  describe("", kSender);
  begin();
  ask("month");
  loop_.run_for(hours{2});
  ASSERT_THAT(ended_, SizeIs(1));
  EXPECT_EQ(ended_[0].state, JobState::failed);
  EXPECT_THAT(ended_[0].message, HasSubstr("the weather of sensor 'roof' has no dry_bulb_C"));
  EXPECT_THAT(ended_[0].message, HasSubstr("; weather is incomplete in 2025-06 to 2025-11 (0 %); "
                                           "recald calibrates again when more arrives"));
  send(calendar_.month_span(year{2025} / 6).begin, kDecember);
  loop_.run_for(hours{2});
  ASSERT_THAT(ended_, SizeIs(2));
  EXPECT_EQ(ended_[1].state, JobState::done) << ended_[1].message;
  EXPECT_EQ(last_month(result_of(ended_[1])), "2025-11");
}

// A file that is just being written again has nothing for a moment.
TEST_F(Sent, AFileThatCannotBeReadIsWaitedFor) {
  describe("[weather]\nfile = \"weather.csv\"\nvalues = \"mean\"\n", "");
  whole_file_ = read_text(folder_ / "weather.csv");
  std::filesystem::remove(folder_ / "weather.csv");
  begin();
  ask("month");
  loop_.run_for(hours{2});
  ASSERT_THAT(ended_, SizeIs(1));
  EXPECT_EQ(ended_[0].state, JobState::failed);
  write_text(folder_ / "weather.csv", whole_file_);
  loop_.run_for(hours{2});
  ASSERT_THAT(ended_, SizeIs(2));
  EXPECT_EQ(ended_[1].state, JobState::done) << ended_[1].message;
}

// Thirty hours of one temperature, to the last digit, is no weather.
TEST_F(Sent, AFrozenThermometerIsNotBelieved) {
  describe("", kSender);
  begin();
  for (Instant t = kNovember + days{4}; t < kNovember + days{5} + hours{6}; t += hours{1}) {
    truth_.hours[static_cast<std::size_t>((t - truth_.begin) / hours{1})].dry_bulb_C = 12.5;
  }
  send(kNovember, kDecember);
  const auto live = open_sensors(site_).value();
  const metering::Month month{year{2025} / 11};
  const auto read = load_weather(site_, calendar_, {month, month}, live.get());
  ASSERT_TRUE(read.has_value()) << read.error().message;
  EXPECT_NEAR(weather_coverage(*read, month), 1.0 - 30.0 / 720.0, 1e-9);
  EXPECT_THAT(read->notes, Contains("Sensor 'roof': 30 intervals of a dry bulb that stood still "
                                    "are not used."));
}

// It talks, but is not believed: that is no silence.
TEST_F(Sent, AHoleThatIsNoSilenceIsNotCalledOne) {
  describe("", kSender);
  begin();
  const Instant june = calendar_.month_span(year{2025} / 6).begin;
  for (Instant t = kNovember + days{4}; t < kNovember + days{6}; t += hours{1}) {
    truth_.hours[static_cast<std::size_t>((t - truth_.begin) / hours{1})].dry_bulb_C = 12.5;
  }
  send(june + days{10}, kDecember);
  const auto live = open_sensors(site_).value();
  const metering::Month november{year{2025} / 11};
  const auto read = load_weather(site_, calendar_, {year{2025} / 6, november}, live.get());
  ASSERT_TRUE(read.has_value()) << read.error().message;
  EXPECT_EQ(read->silence.at(november),
            "Nothing is known from 2025-11-04T23:00:00Z to 2025-11-06T23:00:00Z (dry_bulb_C).");
  // Nor is the time before it was connected.
  EXPECT_THAT(read->silence.at(year{2025} / 6), HasSubstr("Nothing is known from"));
}

// The month that lacked weather is known as well by itself as among all others: a calibration that
// cannot be better is not asked for again.
TEST_F(Sent, ATypicalYearFillsAlikeHoweverManyMonthsAreLookedAt) {
  describe("", kSender);
  begin();
  const metering::Month june{year{2025} / 6};
  const metering::Month november{year{2025} / 11};
  send(calendar_.month_span(june).begin + days{10}, kNovember - days{2});
  const FileWeather typical{truth_, true};
  const auto live = open_sensors(site_).value();
  for (const metering::Month first : {june, november}) {
    SiteWeather result;
    const auto merged =
        merge_with_sensors(site_, calendar_, {first, november}, typical, live.get(), result);
    ASSERT_TRUE(merged.has_value()) << merged.error().message;
    EXPECT_TRUE(result.from.at(november).empty()) << metering::to_string(first);
    if (first == june) {  // before the sensor
      EXPECT_NEAR(result.from.at(june).at(""), 1.0 / 3.0, 1e-9);
    }
  }
}

// Values at the stamp, an hour apart: the mean of an hour lies between two of them.
TEST_F(Sent, InstantsAreNotTakenForMeans) {
  describe("", std::string{kSender} + "values = \"instant\"\n");
  begin();
  for (std::size_t i = 0; i < truth_.hours.size(); ++i) {
    truth_.hours[i].dry_bulb_C = 0.004 * static_cast<double>(i) - 10.0;
  }
  send(kNovember, kDecember);
  const auto live = open_sensors(site_).value();
  const metering::Month month{year{2025} / 11};
  const auto read = load_weather(site_, calendar_, {month, month}, live.get());
  ASSERT_TRUE(read.has_value()) << read.error().message;
  for (Instant t = kNovember; t < kDecember - hours{1}; t += hours{1}) {
    ASSERT_NEAR(read->filled.series.find(t)->dry_bulb_C, truth_.find(t)->dry_bulb_C + 0.002, 1e-9);
    // The sun is a mean anyway.
    ASSERT_NEAR(read->filled.series.find(t)->ghi_W_m2, truth_.find(t)->ghi_W_m2, 1e-9);
  }
}

}  // namespace
}  // namespace recald::daemon::live_weather_test
