/// A site whose readings are in the daemon's store instead of files: every command and every job
/// reads them there, and makes of them what it would have made of a file.
#include <gmock/gmock.h>

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>

#include "adapters/sqlite/sqlite_store.hpp"
#include "core/model/hourly/hourly_run.hpp"
#include "daemon/gateway/run/site_jobs.hpp"
#include "daemon/site/model/load_expectation.hpp"
#include "daemon/site/model/site_parts.hpp"
#include "tests/daemon/command_line.hpp"
#include "tests/daemon/depot_versions.hpp"
#include "tests/daemon/depot_year.hpp"

namespace recald::daemon {
namespace {

using Json = nlohmann::json;
using recald::daemon::testing::Outcome;
using recald::daemon::testing::run;
using recald::testing::read_text;
using recald::testing::TemporaryFolder;
using recald::testing::write_text;
using ::testing::HasSubstr;
using ::testing::Not;

JobWatch& nobody_stops_it() {
  static JobWatch watch;
  return watch;
}

void replace(std::string& text, const std::string& from, const std::string& to) {
  for (auto at = text.find(from); at != std::string::npos; at = text.find(from, at + to.size())) {
    text.replace(at, from.size(), to);
  }
}

class LiveSite : public ::testing::Test {
 protected:
  explicit LiveSite(int hours = recald::testing::kDepotYear_h) {
    recald::testing::write_depot_year(folder_.path(), recald::testing::sample_site(), hours);
    std::string live = recald::testing::sample_site();
    replace(live, "file = \"readings.csv\"\nrated_kW = 400",
            "source = \"modbus\"\nbus = \"plant\"\nunit = 1\nmap = \"abb-b23\"\nrated_kW = 400\n"
            "interval = \"1h\"");
    replace(live, "file = \"readings.csv\"\nname_in_file = \"heat\"",
            "source = \"modbus\"\nbus = \"plant\"\nunit = 2\nmap = \"eastron-sdm630\"\n"
            "rated_kW = 900\ninterval = \"1h\"");
    live += "\n[bus.plant]\ntype = \"tcp\"\nhost = \"127.0.0.1\"\n";
    write_text(folder_ / "live.toml", live);
    // A history names meters as the site does.
    std::string history = read_text(folder_ / "readings.csv");
    replace(history, ",heat,", ",district_heat,");
    write_text(folder_ / "history.csv", history);
  }
  [[nodiscard]] std::string path(const char* name) const { return (folder_ / name).string(); }

  void import_history() {
    const Outcome imported =
        run({"import", path("live.toml"), path("history.csv"), "--reason", "the old system"});
    ASSERT_EQ(imported.exit_code, 0) << imported.err;
  }

  TemporaryFolder folder_;
};

TEST_F(LiveSite, BeforeItsFirstReadingItIsToldThatThereIsNone) {
  for (const char* command : {"calibrate", "replay", "profile"}) {
    const Outcome outcome = run({command, path("live.toml")});
    EXPECT_EQ(outcome.exit_code, 1) << command;
    EXPECT_THAT(outcome.err, HasSubstr("live.db does not exist yet")) << command;
  }
}

TEST_F(LiveSite, AStoreWithoutAnyReadingIsToldApartFromNone) {
  write_text(folder_ / "nothing.csv", "timestamp,meter,value,unit\n");
  run({"import", path("live.toml"), path("nothing.csv"), "--reason", "made by it"});
  const Outcome outcome = run({"calibrate", path("live.toml")});
  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_THAT(outcome.err, HasSubstr("the store has no closed month of meter 'electricity' yet"));
}

TEST_F(LiveSite, AModelledMeterThatWasNeverReadIsNamed) {
  std::string history = read_text(folder_ / "history.csv");
  replace(history, ",district_heat,", ",somewhere_else,");
  write_text(folder_ / "history.csv", history);
  run({"import", path("live.toml"), path("history.csv"), "--reason", "half of it"});
  const Outcome outcome = run({"calibrate", path("live.toml")});
  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_THAT(outcome.err, HasSubstr("no closed month of meter 'district_heat' yet"));
}

TEST(ProfileMeter, IsTheModelledOneThatCountsLightsAndPlugs) {
  SiteConfig site;
  const auto add = [&](const char* id, std::optional<model::EndUse> only) {
    MeterConfig config;
    config.meter.id = id;
    config.meter.utility = metering::Utility::electricity;
    if (only) {
      config.end_uses.emplace();
      (*config.end_uses)[*only] = 1.0;
    }
    site.meters.push_back(config);
  };
  site.model.emplace();
  EXPECT_FALSE(profile_meter(site).has_value());
  add("chillers", model::EndUse::chiller);
  site.model->outputs = {"chillers"};
  EXPECT_EQ(profile_meter(site), 0U);
  add("tenant", {});
  add("main", {});
  EXPECT_EQ(profile_meter(site), 1U);
  site.model->outputs = {"chillers", "main"};
  EXPECT_EQ(profile_meter(site), 2U);
}

TEST_F(LiveSite, ItsModelExpectsWhatTheMetersRead) {
  import_history();
  const auto config = load_site(path("live.toml"));
  ASSERT_TRUE(config.has_value());
  const OpenSite site{*config, metering::LocalCalendar::open(config->timezone).value()};
  const metering::Instant end =
      recald::testing::kDepotBegin + std::chrono::hours{recald::testing::kDepotYear_h};
  const auto expectation = LoadExpectation::learn(site, end + std::chrono::days{5});
  ASSERT_TRUE(expectation.has_value()) << expectation.error().message;
  // The weather file ends with the year, in the middle of what is asked for.
  const auto expected =
      expectation->expect({end - std::chrono::days{8}, end + std::chrono::days{8}});
  ASSERT_TRUE(expected.has_value()) << expected.error().message;
  ASSERT_EQ(expected->size(), 2U);
  auto store = sqlite::SqliteStore::open(path("live.db")).value();
  for (const ExpectedMeter& meter : *expected) {
    SCOPED_TRACE(meter.meter);
    ASSERT_EQ(meter.hours.size(), 8 * 24);
    EXPECT_EQ(meter.hours.front().start, end - std::chrono::days{8});
    std::map<metering::Instant, double> read_kW;
    const auto read = store.for_each_interval(
        store.find_meter(meter.meter).value().value(), {end - std::chrono::days{8}, end},
        [&](const StoredInterval& one) { read_kW[one.reading.start] = one.reading.mean_kW; });
    ASSERT_TRUE(read.has_value());
    const auto inside = std::ranges::count_if(meter.hours, [&](const ExpectedHour& hour) {
      return hour.load.q05_kW <= read_kW.at(hour.start) &&
             read_kW.at(hour.start) <= hour.load.q95_kW;
    });
    EXPECT_GT(inside, 7 * 24);
  }
}

// December as of its 17th, from the eleven months before it and half of its own.
TEST_F(LiveSite, ItsMonthIsForecastWhileItGoesOn) {
  import_history();
  const auto config = load_site(path("live.toml"));
  ASSERT_TRUE(config.has_value());
  const OpenSite site{*config, metering::LocalCalendar::open(config->timezone).value()};
  const metering::Instant end =
      recald::testing::kDepotBegin + std::chrono::hours{recald::testing::kDepotYear_h};
  const metering::Instant now = end - std::chrono::days{15};
  const metering::TimeSpan month = site.calendar.month_span(site.calendar.month_of(now));
  const auto expectation = LoadExpectation::learn(site, now);
  ASSERT_TRUE(expectation.has_value()) << expectation.error().message;
  const auto expected = expectation->expect({now - std::chrono::days{8}, now});
  ASSERT_TRUE(expected.has_value()) << expected.error().message;
  auto store = sqlite::SqliteStore::open(path("live.db")).value();
  for (const ExpectedMeter& meter : *expected) {
    SCOPED_TRACE(meter.meter);
    ASSERT_TRUE(meter.month.has_value());
    EXPECT_EQ(meter.month->month, site.calendar.month_of(now));
    EXPECT_EQ(meter.month->rest_from, now);
    const auto mean_kW = [&](const metering::TimeSpan& span) {
      double sum_kW = 0.0;
      int count = 0;
      (void)store.for_each_interval(store.find_meter(meter.meter).value().value(), span,
                                    [&](const StoredInterval& one) {
                                      sum_kW += one.reading.mean_kW;
                                      ++count;
                                    });
      return sum_kW / count;
    };
    const double elapsed =
        metering::in_hours(now - month.begin) / metering::in_hours(month.length());
    const double forecast_kW =
        elapsed * mean_kW({month.begin, now}) + (1.0 - elapsed) * meter.month->rest_kW;
    const double scale_kW = drift::forecast_scale_kW(forecast_kW, meter.month->mean_kW);
    const double error = (mean_kW(month) - forecast_kW) / scale_kW;
    EXPECT_GE(error, meter.month->error_q05);
    EXPECT_LE(error, meter.month->error_q95);
    // Of heat the spring and the autumn of the only year were forecast from too little.
    const double width = meter.month->error_q95 - meter.month->error_q05;
    EXPECT_GT(width, 0.0);
    EXPECT_LT(width, meter.meter == "electricity" ? 0.02 : 2.0);
  }
}

TEST_F(LiveSite, CalibratesAsASiteWithTheSameReadingsInAFile) {
  import_history();
  const auto calibrated = [&](const char* site) {
    const Outcome outcome =
        run({"calibrate", path(site), "--json", "--draws", "600", "--burn-in", "200"});
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    return Json::parse(outcome.out);
  };
  // Two plausibilities differ: a live counter has a rated power.
  std::string with_file = read_text(folder_ / "site.toml");
  replace(with_file, "name_in_file = \"heat\"", "name_in_file = \"heat\"\nrated_kW = 900");
  write_text(folder_ / "site.toml", with_file);
  const Json from_file = calibrated("site.toml");
  const Json from_store = calibrated("live.toml");
  EXPECT_EQ(from_store["months"], from_file["months"]);
  EXPECT_EQ(from_store["parameters"], from_file["parameters"]);
  EXPECT_EQ(from_store["after"], from_file["after"]);
  EXPECT_NE(from_store["data_revision"], from_file["data_revision"]);
}

/// The depot's electricity read by two meters, half of it each: one is polled, one is pushed.
class HalvesOfALiveSite : public LiveSite {
 protected:
  HalvesOfALiveSite() {
    const std::string live = read_text(folder_ / "live.toml");
    const auto begin = live.find("[[meter]]");
    const auto end = live.find("[[meter]]", begin + 1);
    std::string east = live.substr(begin, end - begin);
    replace(east, "id = \"electricity\"", "id = \"east\"");
    const std::string west =
        "[[meter]]\nid = \"west\"\nutility = \"electricity\"\nsource = \"http\"\n"
        "interval = \"1h\"\nrated_kW = 400\n\n";
    const std::string sum =
        "[[meter]]\nid = \"electricity\"\nutility = \"electricity\"\nrated_kW = 400\n"
        "sum_of = [\"east\", \"west\"]\n\n";
    write_text(folder_ / "live.toml", live.substr(0, begin) + east + west + sum + live.substr(end) +
                                          "\n[http]\nlisten = \"127.0.0.1:8080\"\n");
    std::istringstream whole{read_text(folder_ / "history.csv")};
    std::string halves;
    for (std::string line; std::getline(whole, line);) {
      const auto name = line.find(",electricity,");
      if (name == std::string::npos) {
        halves += line + "\n";
        continue;
      }
      const double half = 0.5 * std::stod(line.substr(name + 13));
      for (const char* id : {"east", "west"}) {
        halves += fmt::format("{},{},{:.7f},kW\n", line.substr(0, name), id, half);
      }
    }
    write_text(folder_ / "history.csv", halves);
  }
};

TEST_F(HalvesOfALiveSite, AreCalibratedAsTheirSum) {
  import_history();
  const auto calibrated = [&](const char* site) {
    const Outcome outcome =
        run({"calibrate", path(site), "--json", "--draws", "600", "--burn-in", "200"});
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    return Json::parse(outcome.out);
  };
  std::string with_file = read_text(folder_ / "site.toml");
  replace(with_file, "name_in_file = \"heat\"", "name_in_file = \"heat\"\nrated_kW = 900");
  write_text(folder_ / "site.toml", with_file);
  const Json from_file = calibrated("site.toml");
  const Json from_store = calibrated("live.toml");
  EXPECT_EQ(from_store["months"], from_file["months"]);
  EXPECT_EQ(from_store["parameters"], from_file["parameters"]);
}

TEST_F(HalvesOfALiveSite, ReplayAsTheirSum) {
  import_history();
  const Outcome replayed = run({"replay", path("live.toml")});
  ASSERT_EQ(replayed.exit_code, 0) << replayed.err;
  EXPECT_THAT(replayed.err, HasSubstr("electricity: 8760 readings every 3600 s (the sum of east, "
                                      "west)\n"));
}

// What `check` says to do can be done.
TEST_F(HalvesOfALiveSite, AreSummedAsCheckSays) {
  const std::string sum = read_text(folder_ / "live.toml");
  std::string both = sum;
  replace(both, "outputs = [\"electricity\"", "outputs = [\"east\", \"west\"");
  write_text(folder_ / "live.toml", both);
  EXPECT_THAT(run({"check", path("live.toml")}).err,
              HasSubstr("add a [[meter]] with sum_of = [\"east\", \"west\"]"));
  write_text(folder_ / "live.toml", sum);
  const Outcome check = run({"check", path("live.toml")});
  EXPECT_EQ(check.exit_code, 0) << check.err;
  EXPECT_THAT(check.out, HasSubstr("the sum of east, west\n"));
}

TEST_F(HalvesOfALiveSite, OneInAFileIsNamed) {
  std::string mixed = read_text(folder_ / "live.toml");
  replace(mixed, "source = \"http\"", "file = \"readings.csv\"");
  write_text(folder_ / "live.toml", mixed);
  EXPECT_THAT(run({"check", path("live.toml")}).err,
              HasSubstr("'sum_of' names 'east', which is read live, and 'west', which is in a "
                        "file; sum meters of one kind"));
  replace(mixed, "file = \"readings.csv\"\ninterval = \"1h\"",
          "source = \"http\"\ninterval = \"30m\"");
  write_text(folder_ / "live.toml", mixed);
  EXPECT_THAT(run({"check", path("live.toml")}).err,
              HasSubstr("'sum_of' names 'east' and 'west', whose intervals are 3600 s and 1800 s"));
}

// What the API shows is what is calibrated: a month that was closed otherwise is taken as it
// stands.
TEST_F(LiveSite, CalibratesOnTheMonthsThatTheStoreHas) {
  import_history();
  metering::MonthlyFigure march;
  {
    auto store = sqlite::SqliteStore::open(folder_ / "live.db").value();
    const std::uint32_t heat = store.find_meter("district_heat").value().value();
    march = store.months(heat).value()[2].figure;
    march.daily_average_kWh = 4321.0;
    ASSERT_EQ(store.put_month(heat, march, "2025b", metering::Instant{}), 1);
  }
  const Outcome outcome =
      run({"calibrate", path("live.toml"), "--json", "--draws", "600", "--burn-in", "200"});
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("4321.0"));
}

TEST_F(LiveSite, AChangedRuleIsToldUntilItsMonthsAreClosedAnew) {
  import_history();
  std::string live = read_text(folder_ / "live.toml");
  replace(live, "rated_kW = 900", "rated_kW = 901");
  write_text(folder_ / "live.toml", live);
  const auto calibrated = [&] {
    return run({"calibrate", path("live.toml"), "--json", "--draws", "600", "--burn-in", "200"});
  };
  EXPECT_THAT(calibrated().out, HasSubstr("closed months of 'district_heat' wait"));
  run({"import", path("live.toml"), path("history.csv"), "--reason", "once more"});
  EXPECT_THAT(calibrated().out, Not(HasSubstr("closed months of")));
}

// The history ends with 2021; that nobody has read the meters since is no reason to close months.
TEST_F(LiveSite, AnImportClosesNoMonthBeyondItsReadings) {
  import_history();
  const Outcome months = run({"export", path("live.toml"), "--months"});
  EXPECT_THAT(months.out, HasSubstr("2021-12,electricity"));
  EXPECT_THAT(months.out, Not(HasSubstr("2022-01")));
}

TEST_F(LiveSite, TheDataRevisionIsThatOfTheReadings) {
  import_history();
  const auto revision = [&] {
    const Outcome outcome =
        run({"calibrate", path("live.toml"), "--json", "--draws", "300", "--burn-in", "100"});
    return Json::parse(outcome.out)["data_revision"].get<std::string>();
  };
  const std::string before = revision();
  EXPECT_EQ(revision(), before);
  write_text(folder_ / "more.csv",
             "timestamp,meter,value,unit\n2021-05-05T10:00:00Z,electricity,61.5,kW\n");
  ASSERT_EQ(
      run({"import", path("live.toml"), path("more.csv"), "--reason", "put right", "--supersede"})
          .exit_code,
      0);
  EXPECT_NE(revision(), before);
}

TEST_F(LiveSite, AJobCalibratesOnTheLatestClosedMonths) {
  import_history();
  auto config = load_site(folder_ / "live.toml").value();
  config.recalibration.months = 8;
  const auto calendar = metering::LocalCalendar::open(config.timezone).value();
  const DoJob work = make_site_work(share({config, calendar}));
  StoredJob job;
  job.number = 7;
  const metering::Instant now = std::chrono::sys_days{std::chrono::year{2021} / 12 / 20};

  const auto outcome = work(job, now, nobody_stops_it());
  ASSERT_TRUE(outcome.has_value()) << outcome.error().message;
  Json result = Json::parse(outcome->result.document);
  EXPECT_THAT(result["drift_not_followed"].get<std::string>(),
              HasSubstr("needs 13 months of all modelled meters"));
  result.erase("drift_not_followed");  // what has changed is said beside the calibration's own file
  ASSERT_EQ(result["months"].size(), 8U);
  EXPECT_EQ(result["months"].front()["month"], "2021-04");
  EXPECT_EQ(result["months"].back()["month"], "2021-11");
  EXPECT_EQ(outcome->folder, path("live-results") + "/calibration-7");
  EXPECT_EQ(Json::parse(read_text(std::filesystem::path{outcome->folder} / "calibration.json")),
            result);
  EXPECT_TRUE(std::filesystem::exists(std::filesystem::path{outcome->folder} / "report.html"));
  EXPECT_TRUE(outcome->forecasts.empty());
}

/// Of a job that failed, whether or not what is known of its weather came with it; empty: it did
/// not.
std::string why_failed(const Result<JobOutcome>& outcome) {
  if (!outcome) return outcome.error().message;
  return outcome->failed ? outcome->message : "";
}

TEST_F(LiveSite, AJobCalibratesTheMetamodelOfAStoredDesign) {
  import_history();
  ASSERT_EQ(run({"doe", path("live.toml"), "--runs", "60", "--out", path("doe")}).exit_code, 0);
  auto config = load_site(folder_ / "live.toml").value();
  config.recalibration.months = 8;
  config.recalibration.design = folder_ / "doe";
  const DoJob work =
      make_site_work(share({config, metering::LocalCalendar::open(config.timezone).value()}));
  const auto outcome =
      work({}, std::chrono::sys_days{std::chrono::year{2021} / 12 / 20}, nobody_stops_it());
  ASSERT_TRUE(outcome.has_value()) << outcome.error().message;
  const Json result = Json::parse(outcome->result.document);
  EXPECT_EQ(result["model"], "metamodel");
  EXPECT_TRUE(outcome->accepted) << outcome->message;
  // Nine months were simulated; October and November, measured since, show how well it does.
  std::map<std::string, int> months;
  for (const Json& month : result["months"]) ++months[month["role"].get<std::string>()];
  EXPECT_EQ(months, (std::map<std::string, int>{{"calibration", 9}, {"validation", 2}}));
  const std::filesystem::path folder{outcome->folder};
  EXPECT_TRUE(std::filesystem::exists(folder / "calibration.json"));
  // The same page as of a site's own model, and the months as they were recorded.
  EXPECT_THAT(read_text(folder / "report.html"), HasSubstr("<h1>Calibration of Tram depot</h1>"));
  EXPECT_THAT(read_text(folder / "months.csv"), HasSubstr("\n2021-11,district_heat,"));
  EXPECT_THAT(read_text(folder / "months.csv"), HasSubstr(",block-"));
}

TEST_F(LiveSite, ADesignOfAnotherSiteIsRefused) {
  import_history();
  ASSERT_EQ(run({"doe", path("site.toml"), "--runs", "60", "--out", path("doe")}).exit_code, 0);
  auto config = load_site(folder_ / "live.toml").value();
  config.recalibration.design = folder_ / "doe";
  const auto calendar = metering::LocalCalendar::open(config.timezone).value();
  const auto outcome = make_site_work(share({config, calendar}))(
      {}, std::chrono::sys_days{std::chrono::year{2021} / 12 / 20}, nobody_stops_it());
  EXPECT_THAT(why_failed(outcome), HasSubstr("not for this site"));
}

TEST_F(LiveSite, AJobSaysThatItsDesignIsMissing) {
  import_history();
  auto config = load_site(folder_ / "live.toml").value();
  config.recalibration.design = folder_ / "nowhere";
  const auto calendar = metering::LocalCalendar::open(config.timezone).value();
  const auto outcome = make_site_work(share({config, calendar}))(
      {}, std::chrono::sys_days{std::chrono::year{2021} / 12 / 20}, nobody_stops_it());
  EXPECT_THAT(why_failed(outcome), HasSubstr("nowhere"));
}

TEST_F(LiveSite, AJobThatIsToldToStopStops) {
  import_history();
  const auto config = load_site(folder_ / "live.toml").value();
  const DoJob work =
      make_site_work(share({config, metering::LocalCalendar::open(config.timezone).value()}));
  JobWatch watch;
  watch.stop();
  const auto outcome = work({}, std::chrono::sys_days{std::chrono::year{2022} / 2 / 1}, watch);
  ASSERT_FALSE(outcome.has_value());
  EXPECT_EQ(outcome.error().code, ErrorCode::cancelled);
  EXPECT_LT(watch.progress()->share, 0.1);  // it asked early on
}

// It stands before the main meter, is of electricity too, and has never been read.
TEST_F(LiveSite, AMeterThatTheModelHasNoUseForStopsNothing) {
  import_history();
  const auto calibrated = [&] {
    const Outcome outcome =
        run({"calibrate", path("live.toml"), "--json", "--draws", "300", "--burn-in", "100"});
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    return Json::parse(outcome.out);
  };
  const Json before = calibrated();
  std::string text = read_text(folder_ / "live.toml");
  const auto first = text.find("[[meter]]");
  text.insert(first,
              "[[meter]]\nid = \"tenant\"\nutility = \"electricity\"\nsource = \"modbus\"\n"
              "bus = \"plant\"\nunit = 3\nmap = \"abb-b23\"\nrated_kW = 50\n"
              "interval = \"1h\"\n\n");
  write_text(folder_ / "live.toml", text);
  const Json beside = calibrated();
  EXPECT_EQ(beside["parameters"], before["parameters"]);

  const Outcome replayed = run({"replay", path("live.toml"), "--json"});
  ASSERT_EQ(replayed.exit_code, 0) << replayed.err;
  const Json meters = Json::parse(replayed.out)["meters"];
  ASSERT_EQ(meters.size(), 3U);
  EXPECT_EQ(meters[0]["meter"], "tenant");
  EXPECT_EQ(meters[0]["months"], 0);
  EXPECT_EQ(meters[1]["months"], 12);

  write_text(folder_ / "tenant.csv",
             "timestamp,meter,value,unit\n2021-05-05T10:00:00Z,tenant,21.5,kW\n");
  ASSERT_EQ(
      run({"import", path("live.toml"), path("tenant.csv"), "--reason", "read off"}).exit_code, 0);
  EXPECT_EQ(calibrated()["data_revision"], beside["data_revision"]);
}

/// Fifteen months: twelve to learn from, the rest to forecast as they close.
class FollowedSite : public LiveSite {
 protected:
  FollowedSite() : LiveSite(recald::testing::kDepotYear_h + 90 * 24) { import_history(); }

  /// All that the record holds after a job on that day.
  std::vector<StoredForecast> after_a_job(std::chrono::year_month_day day) {
    auto config = load_site(folder_ / "live.toml").value();
    config.recalibration.months = 8;
    const DoJob work =
        make_site_work(share({config, metering::LocalCalendar::open(config.timezone).value()}));
    const auto outcome = work({}, std::chrono::sys_days{day}, nobody_stops_it());
    EXPECT_TRUE(outcome.has_value()) << outcome.error().message;
    EXPECT_TRUE(store_.add_forecasts(outcome->forecasts).has_value());
    return store_.forecasts().value();
  }

  sqlite::SqliteStore store_ = sqlite::SqliteStore::open(folder_ / "record.db").value();
};

std::vector<std::string> told(const std::vector<StoredForecast>& forecasts) {
  std::vector<std::string> lines;
  for (const StoredForecast& one : forecasts) {
    lines.push_back(fmt::format("{} {} r{} {} {:.17g} {:.17g}", one.output,
                                metering::to_string(one.month), one.revision, one.model_version,
                                one.mean, one.standardised));
  }
  return lines;
}

TEST_F(FollowedSite, NeitherAClockThatWentBackNorAnotherModelRewritesWhatWasSaid) {
  using std::chrono::year;
  const auto first = told(after_a_job(year{2022} / 3 / 20));
  ASSERT_EQ(first.size(), 4U);  // two outputs of January and February
  EXPECT_THAT(first.back(), HasSubstr("2022-02 r0 epc-"));

  // The clock says February again, when only January has closed, and the model is another one.
  const std::string version =
      recald::testing::put_in_force(recald::testing::half_missing_setback({}), path("live.toml"));
  const auto both = told(after_a_job(year{2022} / 2 / 10));
  ASSERT_EQ(both.size(), 6U);
  for (const std::string& said : first) EXPECT_THAT(both, ::testing::Contains(said));
  EXPECT_EQ(
      std::ranges::count_if(
          both, [&](const auto& said) { return said.find("2022-01 r1 " + version) < said.size(); }),
      2);
}

TEST_F(LiveSite, AJobBeforeAnyMonthHasClosedSaysSo) {
  import_history();
  const auto config = load_site(folder_ / "live.toml").value();
  const DoJob work =
      make_site_work(share({config, metering::LocalCalendar::open(config.timezone).value()}));
  const auto outcome =
      work({}, std::chrono::sys_days{std::chrono::year{2021} / 1 / 20}, nobody_stops_it());
  EXPECT_THAT(why_failed(outcome), HasSubstr("has no usable closed month yet"));
}

}  // namespace
}  // namespace recald::daemon
