/// Exports that are no rows of one time and one load each: from `init` to the months of `replay`.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <functional>
#include <map>
#include <sstream>

#include "../command_line.hpp"
#include "tests/support/sample_exports.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/support/zip_file.hpp"

namespace recald::daemon::init_layouts_test {
namespace {

using metering::Instant;
using metering::LocalCalendar;
using recald::testing::clock_text;
using recald::testing::ExportTruth;
using recald::testing::read_text;
using recald::testing::with_comma;
using recald::testing::with_point;
using recald::testing::write_text;
using std::chrono::minutes;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;
using testing::Outcome;
using testing::run;
using ::testing::SizeIs;

using Months = std::map<std::string, std::map<std::string, double>>;

class InitLayouts : public ::testing::Test {
 protected:
  [[nodiscard]] std::filesystem::path path(const std::string& name) const { return folder_ / name; }

  [[nodiscard]] ExportTruth truth(unsigned seed, int step, const char* first = "2024-03-01",
                                  const char* last = "2024-04-30") const {
    return recald::testing::made_up_use(
        calendar_, {*metering::parse_day(first), *metering::parse_day(last), minutes{step}}, seed,
        10.0);
  }

  /// What `init` and then `replay` make of a file: kWh by meter and month.
  Months months_of(const std::string& name, const std::string& text) {
    write_text(path(name), text);
    return months_of(name);
  }
  Months months_of(const std::string& name) {
    outcome_ = run({"init", path(name).string(), "--timezone", calendar_.zone_name(), "--out",
                    path("site").string()});
    EXPECT_EQ(outcome_.exit_code, kSuccess) << outcome_.err;
    if (outcome_.exit_code != kSuccess) return {};
    site_ = read_text(path("site/site.toml"));
    const Outcome replayed =
        run({"replay", path("site/site.toml").string(), "--out", path("results").string()});
    EXPECT_EQ(replayed.exit_code, kSuccess) << replayed.err << site_;
    Months months;
    std::ifstream in{path("results/months.csv")};
    std::string line;
    std::getline(in, line);
    while (std::getline(in, line)) {
      std::istringstream fields{line};
      std::string month;
      std::string meter;
      std::string daily;
      std::getline(fields, month, ',');
      std::getline(fields, meter, ',');
      std::getline(fields, daily, ',');
      months[meter][month] =
          daily.empty() ? 0.0 : std::stod(daily) * metering::days_in(*metering::parse_month(month));
    }
    return months;
  }

  static void expect_months(const Months& months, const std::string& meter,
                            const ExportTruth& truth, double kWh_per_unit = 1.0) {
    SCOPED_TRACE(meter);
    ASSERT_TRUE(months.contains(meter));
    EXPECT_THAT(months.at(meter), SizeIs(truth.month_sums.size()));
    for (const auto& [month, sum] : truth.month_sums) {
      ASSERT_TRUE(months.at(meter).contains(month)) << month;
      EXPECT_NEAR(months.at(meter).at(month), sum * kWh_per_unit, 1e-4 * sum * kWh_per_unit)
          << month;
    }
  }

  LocalCalendar calendar_ = *LocalCalendar::open("Europe/Berlin");
  recald::testing::TemporaryFolder folder_;
  Outcome outcome_;
  std::string site_;
};

ExportTruth added(const ExportTruth& a, const ExportTruth& b) {
  ExportTruth sum = a;
  for (std::size_t i = 0; i < sum.intervals.size(); ++i) {
    sum.intervals[i].value += b.intervals[i].value;
  }
  for (auto& [month, value] : sum.month_sums) value += b.month_sums.at(month);
  return sum;
}

// --- Layouts. ---

/// Two registers a day, in rows that come in turns; a column of sums beside them.
TEST_F(InitLayouts, ARowADayWithRegisters) {
  const ExportTruth taken = truth(1, 15, "2024-09-01", "2024-11-30");
  const ExportTruth fed = truth(2, 15, "2024-09-01", "2024-11-30");
  std::string text = "Stelle;Datum;Register;Einheit";
  for (int i = 0; i < 96; ++i) text += fmt::format(";{:02}:{:02}", i / 4, i % 4 * 15);
  text += ";Summe\n";
  std::map<std::string, std::array<std::vector<double>, 2>> days;
  for (std::size_t i = 0; i < taken.intervals.size(); ++i) {
    auto& day = days[clock_text(calendar_, taken.intervals[i].start, "%Y%m%d")];
    day[0].push_back(taken.intervals[i].value);
    day[1].push_back(fed.intervals[i].value);
  }
  for (const auto& [date, both] : days) {
    for (std::size_t k = 0; k < 2; ++k) {
      std::vector<double> values = both[k];
      if (values.size() == 100) {
        for (std::size_t i = 8; i < 12; ++i) values[i] += values[i + 4];
        values.erase(values.begin() + 12, values.begin() + 16);
      }
      text += fmt::format("DE001;{}.{}.{};{};kWh", date.substr(6), date.substr(4, 2),
                          date.substr(0, 4), k == 0 ? "Bezug" : "Lieferung");
      double sum = 0.0;
      for (const double value : values) {
        text += ";" + with_comma(value);
        sum += value;
      }
      text += ";" + with_comma(sum) + "\n";
    }
  }
  const Months months = months_of("tage.csv", text);
  EXPECT_THAT(site_,
              AllOf(HasSubstr("layout = \"row_a_day\""), HasSubstr("time_column = \"Datum\""),
                    HasSubstr("name_in_file = \"Bezug\"")));
  EXPECT_THAT(outcome_.out, HasSubstr("the clock shows an hour twice"));
  expect_months(months, "bezug", taken);
  expect_months(months, "lieferung", fed);
}

TEST_F(InitLayouts, TimesAcrossTheHeader) {
  const ExportTruth in = truth(3, 60);
  const ExportTruth out = truth(4, 60);
  std::string text = "entity_id,type,unit";
  for (const auto& one : in.intervals) text += "," + metering::to_string(one.start);
  for (const auto& [name, of] :
       {std::pair{"sensor.grid_in", &in}, std::pair{"sensor.grid_out", &out}}) {
    text +=
        fmt::format("\n{},{},kWh", name, name == std::string{"sensor.grid_in"} ? "use" : "return");
    for (const auto& one : of->intervals) text += "," + with_point(one.value);
  }
  const Months months = months_of("energy.csv", text + "\n");
  EXPECT_THAT(site_, AllOf(HasSubstr("layout = \"column_a_time\""), Not(HasSubstr("time_column"))));
  expect_months(months, "sensor-grid-in", in);
  expect_months(months, "sensor-grid-out", out);
}

// --- Containers. ---

TEST_F(InitLayouts, Nem12) {
  calendar_ = *LocalCalendar::open("Australia/Sydney");
  const LocalCalendar market = *LocalCalendar::open("Etc/GMT-10");
  const ExportTruth use = recald::testing::made_up_use(
      market, {*metering::parse_day("2024-03-01"), *metering::parse_day("2024-04-30"), minutes{30}},
      5, 10.0);
  std::string text = "100,NEM12,202405010000,MDP,RET\n200,6102345678,E1Q1,,E1,,M1,kWh,30,\n";
  for (const char* channel : {"E1", "Q1"}) {
    if (channel[0] == 'Q') text += "200,6102345678,E1Q1,,Q1,,M1,kVArh,30,\n";
    for (std::size_t i = 0; i < use.intervals.size(); i += 48) {
      text += "300," + clock_text(market, use.intervals[i].start, "%Y%m%d");
      for (std::size_t k = i; k < i + 48; ++k) text += "," + with_point(use.intervals[k].value);
      text += ",A,,,,\n";
    }
  }
  double sum = 0.0;
  for (const auto& one : use.intervals) sum += one.value;
  const Months months = months_of("meter.csv", text + "900\n");
  EXPECT_THAT(site_, AllOf(HasSubstr("format = \"nem12\""),
                           HasSubstr("name_in_file = \"6102345678 / E1\"")));
  EXPECT_THAT(outcome_.out, AllOf(HasSubstr("UTC+10 all year"), HasSubstr("Q1 (kVArh)")));
  ASSERT_THAT(months, SizeIs(1));
  // In summer time Sydney's days begin an hour before the market's.
  double replayed = 0.0;
  for (const auto& [month, kWh] : months.begin()->second) replayed += kWh;
  EXPECT_NEAR(replayed, sum, 0.01 * sum);
}

TEST_F(InitLayouts, AnnotatedCsvOfInflux) {
  const ExportTruth use = truth(6, 15);
  std::string text =
      "#group,false,false,true,true,false,false,true,true\n#datatype,string,long,dateTime:RFC3339,"
      "dateTime:RFC3339,dateTime:RFC3339,double,string,string\n#default,last,,,,,,,\n"
      ",result,table,_start,_stop,_time,_value,_measurement,entity_id\n";
  const std::string span = metering::to_string(use.intervals.front().start) + "," +
                           metering::to_string(use.intervals.back().start + minutes{15}) + ",";
  for (const auto& [start, value] : use.intervals) {
    text += ",,0," + span + metering::to_string(start + minutes{15}) + "," + with_point(value) +
            ",kWh,main\n";
  }
  for (const auto& [start, value] : use.intervals) {
    text += ",,1," + span + metering::to_string(start + minutes{15}) + ",21.5,\xC2\xB0\x43,room\n";
  }
  const Months months = months_of("query.csv", text);
  EXPECT_THAT(site_, AllOf(HasSubstr("format = \"influx\""), HasSubstr("kWh / main"),
                           HasSubstr("stamps = \"end\"")));
  EXPECT_THAT(outcome_.out, HasSubstr("room"));
  ASSERT_THAT(months, SizeIs(1));
  expect_months(months, "main", use);
}

TEST_F(InitLayouts, JsonOfPortals) {
  const ExportTruth use = truth(7, 30);
  const auto readings = [&](const std::function<std::string(Instant, double)>& one) {
    std::string text;
    for (const auto& [start, value] : use.intervals) {
      text += (text.empty() ? "" : ",\n") + one(start, value);
    }
    return text;
  };
  const std::string list = readings([](Instant start, double value) {
    return fmt::format(R"({{"interval_start": "{}", "kWh": {:.3f}}})", metering::to_string(start),
                       value);
  });
  std::string lines = list;
  for (std::size_t at = 0; (at = lines.find(",\n", at)) != std::string::npos;)
    lines.replace(at, 2, "\n");
  std::string times;
  std::string values;
  for (const auto& [start, value] : use.intervals) {
    times += (times.empty() ? "\"" : ",\"") + metering::to_string(start) + "\"";
    values += (values.empty() ? "" : ",") + with_point(value);
  }
  const std::map<std::string, std::string> files{
      {"top.json", "[" + list + "]"},
      {"key.json", R"({"count": 3, "next": null, "results": [)" + list + "]}"},
      {"lines.ndjson", lines + "\n"},
      {"lists.json", R"({"time": [)" + times + R"(], "kWh": [)" + values + "]}"}};
  for (const auto& [name, text] : files) {
    SCOPED_TRACE(name);
    std::filesystem::remove_all(path("site"));
    std::filesystem::remove_all(path("results"));
    const Months months = months_of(name, text);
    EXPECT_THAT(site_, HasSubstr("format = \"json\""));
    ASSERT_THAT(months, SizeIs(1));
    expect_months(months, months.begin()->first, use);
  }
}

// --- One load in several rows or columns. ---

bool is_day_tariff(const LocalCalendar& calendar, Instant t) {
  const auto local = calendar.local_time(t);
  const std::chrono::weekday weekday{std::chrono::sys_days{local.date}};
  return weekday != std::chrono::Saturday && weekday != std::chrono::Sunday &&
         local.minute_of_day >= 7 * 60 && local.minute_of_day < 22 * 60;
}

/// Registers that take turns, use and feed-in with two tariffs each.
TEST_F(InitLayouts, TariffsInRowsThatTakeTurns) {
  const ExportTruth use = truth(8, 15);
  const ExportTruth fed = truth(9, 15);
  std::string text = "Van;Meter;Register;Volume;Eenheid;Status\n";
  for (std::size_t i = 0; i < use.intervals.size(); ++i) {
    const Instant start = use.intervals[i].start;
    const char* tariff = is_day_tariff(calendar_, start) ? "Dag" : "Nacht";
    const std::string stamp = clock_text(calendar_, start, "%d-%m-%Y %H:%M");
    text += fmt::format("{};1SAG33;Afname {};{};kWh;Gelezen\n", stamp, tariff,
                        with_comma(use.intervals[i].value));
    text += fmt::format("{};1SAG33;Injectie {};{};kWh;Gelezen\n", stamp, tariff,
                        with_comma(fed.intervals[i].value));
  }
  const Months months = months_of("kwartier.csv", text);
  EXPECT_THAT(site_, AllOf(HasSubstr("name_in_file = [\"Afname "), HasSubstr("[\"Injectie ")));
  ASSERT_THAT(months, SizeIs(2));
  expect_months(months, "afname", use);
  expect_months(months, "injectie", fed);
}

/// Columns of tariffs: blank, or zero, while the other counts.
TEST_F(InitLayouts, TariffsInColumns) {
  for (const char* rest : {"", "0.000"}) {
    SCOPED_TRACE(rest);
    std::filesystem::remove_all(path("site"));
    std::filesystem::remove_all(path("results"));
    const ExportTruth use = truth(10, 30);
    std::string text = "Horodate,HP (kWh),HC (kWh)\n";
    for (const auto& [start, value] : use.intervals) {
      const bool is_day = is_day_tariff(calendar_, start);
      text += fmt::format("{},{},{}\n", metering::to_string(start),
                          is_day ? with_point(value) : rest, is_day ? rest : with_point(value));
    }
    const Months months = months_of("hphc.csv", text);
    EXPECT_THAT(site_, HasSubstr("column = [\"HP (kWh)\", \"HC (kWh)\"]"));
    ASSERT_THAT(months, SizeIs(1));
    expect_months(months, months.begin()->first, use);
  }
}

/// What counts at the same time are two loads, whatever they are called.
TEST_F(InitLayouts, AHeatPumpAndItsCircuitAreNoTariffs) {
  const ExportTruth pump = truth(11, 30);
  const ExportTruth circuit = truth(12, 30);
  std::string text = "time,HP (kWh),HC (kWh)\n";
  for (std::size_t i = 0; i < pump.intervals.size(); ++i) {
    text += metering::to_string(pump.intervals[i].start) + "," +
            with_point(pump.intervals[i].value) + "," + with_point(circuit.intervals[i].value) +
            "\n";
  }
  const Months months = months_of("pump.csv", text);
  ASSERT_THAT(months, SizeIs(2));
  expect_months(months, "hp", pump);
  expect_months(months, "hc", circuit);
}

TEST_F(InitLayouts, PhasesAreOneLoad) {
  const ExportTruth a = truth(13, 15);
  const ExportTruth b = truth(14, 15);
  const ExportTruth c = truth(15, 15);
  std::string text = "time,Main L1 kWh,Main L2 kWh,Main L3 kWh\n";
  for (std::size_t i = 0; i < a.intervals.size(); ++i) {
    text += metering::to_string(a.intervals[i].start) + "," + with_point(a.intervals[i].value) +
            "," + with_point(b.intervals[i].value) + "," + with_point(c.intervals[i].value) + "\n";
  }
  const Months months = months_of("phases.csv", text);
  ASSERT_THAT(months, SizeIs(1));
  expect_months(months, "main", added(added(a, b), c));
}

/// The total stands beside its tariffs: they are no load of their own.
TEST_F(InitLayouts, ATotalBesideItsTariffsStays) {
  const ExportTruth use = truth(16, 30);
  std::string text = "time,Total kWh,Day kWh,Night kWh\n";
  for (const auto& [start, value] : use.intervals) {
    const bool is_day = is_day_tariff(calendar_, start);
    text += fmt::format("{},{},{},{}\n", metering::to_string(start), with_point(value),
                        is_day ? with_point(value) : "0.000", is_day ? "0.000" : with_point(value));
  }
  const Months months = months_of("total.csv", text);
  ASSERT_THAT(months, SizeIs(3));
  expect_months(months, "total", use);
}

// --- Several meters below each other. ---

TEST_F(InitLayouts, MetersOneAfterAnother) {
  const ExportTruth power = truth(17, 60);
  const ExportTruth gas = truth(18, 60);
  std::string text = "\"Datum\",\"EAN\",\"Verbruik (kWh)\",\"Soort\",\"Piek\"\n";
  for (const auto& [kind, ean, of] : {std::tuple{"Elektriciteit", "871687120000000001", &power},
                                      std::tuple{"Gas", "871687120000000002", &gas}}) {
    for (const auto& [start, value] : of->intervals) {
      text += fmt::format("\"{}\",\"{}\",\"{}\",\"{}\",\"{}\"\n", metering::to_string(start), ean,
                          with_point(value), kind, is_day_tariff(calendar_, start));
    }
  }
  const Months months = months_of("engie.csv", text);
  ASSERT_THAT(months, SizeIs(2));
  expect_months(months, "elektriciteit", power);
  expect_months(months, "gas", gas);
}

TEST_F(InitLayouts, BlocksWithTitlesOrHeadersOfTheirOwn) {
  const ExportTruth east = truth(19, 60);
  const ExportTruth west = truth(20, 60);
  for (const bool have_titles : {true, false}) {
    SCOPED_TRACE(have_titles);
    std::filesystem::remove_all(path("site"));
    std::filesystem::remove_all(path("results"));
    std::string text;
    for (const auto& [name, of] : {std::pair{"East", &east}, std::pair{"West", &west}}) {
      text += have_titles ? fmt::format("Meter;{}\nTime;Use (kWh)\n", name)
                          : fmt::format("Time;{} (kWh)\n", name);
      for (const auto& [start, value] : of->intervals) {
        text += clock_text(calendar_, start, "%Y-%m-%d %H:%M") + ";" + with_comma(value) + "\n";
      }
      text += "\n";
    }
    const Months months = months_of("blocks.csv", text);
    ASSERT_THAT(months, SizeIs(2));
    expect_months(months, have_titles ? "meter-east" : "east", east);
    expect_months(months, have_titles ? "meter-west" : "west", west);
  }
}

// --- Sheets. ---

std::string sheet_of(const std::vector<std::vector<std::string>>& rows) {
  std::string text = "<worksheet><sheetData>";
  for (const auto& row : rows) {
    text += "<row>";
    for (const std::string& cell : row) {
      text += "<c t=\"inlineStr\"><is><t>" + cell + "</t></is></c>";
    }
    text += "</row>";
  }
  return text + "</sheetData></worksheet>";
}

TEST_F(InitLayouts, TheSheetWithTheFinestReadings) {
  const ExportTruth use = truth(21, 15);
  std::map<std::string, std::vector<std::vector<std::string>>> sheets;
  sheets["Notes"] = {{"Made by the portal"}, {"Pages", "3"}};
  for (const auto& [name, step] :
       {std::pair{"day", 96}, std::pair{"hour", 4}, std::pair{"quarter", 1}}) {
    auto& rows = sheets[name];
    rows.push_back({"Time", "Use (kWh)"});
    double sum = 0.0;
    for (std::size_t i = 0; i < use.intervals.size(); ++i) {
      sum += use.intervals[i].value;
      if ((i + 1) % static_cast<std::size_t>(step) != 0) continue;
      const Instant start = use.intervals[i + 1 - static_cast<std::size_t>(step)].start;
      rows.push_back({metering::to_string(start), with_point(sum)});
      sum = 0.0;
    }
  }
  sheets["copy"] = sheets["quarter"];
  std::string book = "<workbook><sheets>";
  std::string relations = "<Relationships>";
  std::map<std::string, std::string> parts;
  for (const char* name : {"Notes", "copy", "day", "hour", "quarter"}) {
    book += fmt::format("<sheet name=\"{0}\" r:id=\"{0}\"{1}/>", name,
                        name == std::string{"copy"} ? " state=\"hidden\"" : "");
    relations += fmt::format("<Relationship Id=\"{0}\" Target=\"{0}.xml\"/>", name);
    parts[fmt::format("xl/{}.xml", name)] = sheet_of(sheets[name]);
  }
  parts["xl/workbook.xml"] = book + "</sheets></workbook>";
  parts["xl/_rels/workbook.xml.rels"] = relations + "</Relationships>";
  recald::testing::write_zip(path("hist.xlsx"), parts);
  const Months months = months_of("hist.xlsx");
  EXPECT_THAT(site_, HasSubstr("sheet = \"quarter\""));
  EXPECT_THAT(outcome_.out, AllOf(HasSubstr("'day' (a value a day)"), HasSubstr("'hour'"),
                                  Not(HasSubstr("copy")), Not(HasSubstr("Notes"))));
  expect_months(months, "use", use);
}

// --- Green Button. ---

std::string entry(const std::string& self, const std::string& related, const std::string& content) {
  return "<entry><link rel=\"self\" href=\"" + self + "\"/>" +
         (related.empty() ? "" : "<link rel=\"related\" href=\"" + related + "\"/>") + "<content>" +
         content + "</content></entry>";
}

/// Energy by two tariffs, reactive energy beside it.
TEST_F(InitLayouts, AFeedWithTariffsAndReactiveEnergy) {
  const ExportTruth use = truth(22, 60);
  std::string text =
      "<feed>" +
      entry("UsagePoint/1", "",
            "<UsagePoint><ServiceCategory><kind>0</kind></ServiceCategory></UsagePoint>");
  for (const auto& [number, uom, tou] :
       {std::tuple{1, 72, 1}, std::tuple{2, 72, 2}, std::tuple{3, 73, 0}}) {
    const std::string reading = fmt::format("UsagePoint/1/MeterReading/{}", number);
    const std::string type = fmt::format("ReadingType/{}", number);
    text += entry(type, "",
                  fmt::format("<ReadingType><uom>{}</uom><tou>{}</tou><powerOfTenMultiplier>0"
                              "</powerOfTenMultiplier></ReadingType>",
                              uom, tou));
    text += entry(reading, type, "<MeterReading/>");
    std::string block = "<IntervalBlock>";
    for (const auto& [start, value] : use.intervals) {
      const bool is_its = number == 3 || is_day_tariff(calendar_, start) == (tou == 1);
      if (!is_its) continue;
      block += fmt::format(
          "<IntervalReading><timePeriod><duration>3600</duration><start>{}</start></timePeriod>"
          "<value>{}</value></IntervalReading>",
          start.time_since_epoch().count(), std::llround(value * 1000.0));
    }
    text += entry(reading + "/IntervalBlock/1", "", block + "</IntervalBlock>");
  }
  const Months months = months_of("feed.xml", text + "</feed>");
  EXPECT_THAT(site_, HasSubstr("name_in_file = [\"UsagePoint/1/MeterReading/1\", "
                               "\"UsagePoint/1/MeterReading/2\"]"));
  EXPECT_THAT(outcome_.out, HasSubstr("(varh)"));
  ASSERT_THAT(months, SizeIs(1));
  expect_months(months, months.begin()->first, use);
}

}  // namespace
}  // namespace recald::daemon::init_layouts_test
