/// The page of meters alone, as `recald replay` writes it.
#include <gmock/gmock.h>

#include <cmath>
#include <stdexcept>

#include "adapters/views/meters/meters_words.hpp"
#include "tests/adapters/views/page_text.hpp"
#include "tests/daemon/command_line.hpp"
#include "tests/daemon/depot_year.hpp"
#include "tests/support/temporary_folder.hpp"

namespace recald::daemon::meters_report_test {
namespace {

using metering::LevelChange;
using metering::LevelChangeKind;
using metering::Month;
using metering::MonthlyFigure;
using recald::daemon::testing::Outcome;
using recald::daemon::testing::run;
using recald::testing::edited;
using recald::testing::read_text;
using recald::testing::write_text;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

constexpr std::string_view kWeather = R"(
[weather]
file = "weather.csv"
values = "mean"
)";
constexpr int kTwoYears_h = 2 * recald::testing::kDepotYear_h;

class MetersReport : public ::testing::Test {
 protected:
  void write(const std::string& more, int hours = recald::testing::kDepotYear_h) const {
    recald::testing::write_depot_year(folder_ / "",
                                      std::string{recald::testing::kSampleMeters} + more, hours);
  }
  [[nodiscard]] std::string replayed() const {
    const Outcome outcome =
        run({"replay", (folder_ / "site.toml").string(), "--out", (folder_ / "out").string()});
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    return read_text(folder_ / "out" / "meters.html");
  }

  recald::testing::TemporaryFolder folder_;
};

TEST_F(MetersReport, MetersAloneAreEnough) {
  write("");
  const std::string page = replayed();
  EXPECT_THAT(page,
              AllOf(HasSubstr("<h1>Meters of Tram depot</h1>"), HasSubstr("Electricity: "),
                    HasSubstr("District heat: "), HasSubstr("data-figure=\"load\""),
                    HasSubstr("data-figure=\"peaks\""), HasSubstr("data-figure=\"dayprofile\""),
                    HasSubstr("no meter has more than one year yet")));
  EXPECT_THAT(page, Not(HasSubstr("id=\"temperature\"")));
}

TEST_F(MetersReport, TheWeatherExplainsWhatFollowsIt) {
  write(std::string{kWeather}, kTwoYears_h);
  const std::string page = replayed();
  // The depot's heat: 5.2 kWh an hour and kelvin below 15.5 °C.
  EXPECT_THAT(page, HasSubstr("data-figure=\"temperature\""));
  EXPECT_THAT(page, HasSubstr("the months that it had not seen"));
  EXPECT_THAT(page, HasSubstr("<th scope=\"row\">All days</th>"));
  EXPECT_THAT(page, HasSubstr("Not seen"));
}

/// The number before a unit in the row of the page's glance that begins with `meter`.
double used_of(const std::string& page, const std::string& meter, const std::string& unit) {
  const std::size_t row = page.find("<th scope=\"row\">" + meter + "</th>");
  const std::size_t end = page.find("\u00a0" + unit + "</td>", row);
  if (end == std::string::npos) throw std::runtime_error(meter + " has no " + unit);
  const std::size_t begin = page.rfind('>', end) + 1;
  std::string digits = page.substr(begin, end - begin);
  std::erase(digits, ',');
  return std::stod(digits);
}

// The same site twice: its numbers are each other's times the factors of their units, and no SI
// unit is left where a person reads.
TEST_F(MetersReport, SpeaksSiOrIpByOneKey) {
  write(std::string{kWeather}, kTwoYears_h);
  const std::string si = replayed();
  const std::string site = read_text(folder_ / "site.toml");
  write_text(folder_ / "site.toml", edited(site, "[site]\n", "[site]\nunits = \"IP\"\n"));
  const Outcome outcome =
      run({"replay", (folder_ / "site.toml").string(), "--out", (folder_ / "ip").string()});
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  const std::string ip = views::own_markup(read_text(folder_ / "ip" / "meters.html"));
  // Four digits of each number are shown.
  const double mwh = used_of(si, "District heat", "MWh");
  EXPECT_NEAR(used_of(ip, "District heat", "MMBtu"), 3.412142 * mwh, 1e-3 * 3.412142 * mwh);
  EXPECT_NEAR(used_of(ip, "District heat", "MBH"), 3.412142 * used_of(si, "District heat", "kW"),
              1e-3 * used_of(ip, "District heat", "MBH"));
  EXPECT_NEAR(used_of(ip, "Electricity", "kWh"), 1e3 * used_of(si, "Electricity", "MWh"),
              1.0 * used_of(si, "Electricity", "MWh"));
  EXPECT_THAT(si, HasSubstr("°C"));
  EXPECT_THAT(ip, AllOf(Not(HasSubstr("°C")), HasSubstr("MMBtu/day more per °F below")));
  EXPECT_THAT(outcome.out, HasSubstr("MMBtu/day  peak"));
  EXPECT_EQ(read_text(folder_ / "ip" / "months.csv"), read_text(folder_ / "out" / "months.csv"));
}

TEST_F(MetersReport, SaysWhatTheMetersCostWhereTheSiteHasPrices) {
  write("");
  EXPECT_THAT(replayed(), Not(HasSubstr("id=\"costs\"")));
  write(R"(
[tariff]
currency = "EUR"
[tariff.electricity]
per_kWh = 0.25
[emissions]
heating = 0.2
)");
  const std::string page = replayed();
  EXPECT_THAT(page, HasSubstr("What did it cost?"));
  const double electricity_eur = 250.0 * used_of(page, "Electricity", "MWh");
  const std::size_t year = page.find("<th scope=\"row\">2021</th>");
  const std::size_t begin = page.find("</td><td class=\"number\">", year) + 24;
  std::string digits = page.substr(begin, page.find('<', begin) - begin);
  std::erase(digits, ',');
  EXPECT_NEAR(std::stod(digits), electricity_eur, 1e-3 * electricity_eur);
}

TEST_F(MetersReport, WeatherThatIsNotThereIsSaidAndLeavesTheRest) {
  write(std::string{kWeather});
  write_text(folder_ / "weather.csv",
             "timestamp,dry_bulb_C\n2019-01-01T00:00:00Z,4.0\n2019-01-01T01:00:00Z,3.9\n");
  EXPECT_THAT(replayed(), AllOf(HasSubstr("Nothing is said of the weather: "),
                                HasSubstr("data-figure=\"load\"")));
  std::filesystem::remove(folder_ / "weather.csv");
  EXPECT_THAT(replayed(), HasSubstr("Nothing is said of the weather: its file cannot be read."));
}

TEST_F(MetersReport, NeedsNeitherModelNorWeather) {
  write("");
  const std::string page = (folder_ / "page.html").string();
  const Outcome outcome = run({"report", (folder_ / "site.toml").string(), "--out", page});
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_THAT(read_text(page), HasSubstr("<h1>Meters of Tram depot</h1>"));
}

TEST_F(MetersReport, TheSameReadingsGiveTheSamePage) {
  write("");
  setenv("SOURCE_DATE_EPOCH", "1700000000", 1);
  const std::string page = replayed();
  EXPECT_EQ(page, replayed());
  unsetenv("SOURCE_DATE_EPOCH");
  EXPECT_THAT(page, HasSubstr("Made 2023-11-14T22:13:20Z"));
}

MonthlyFigure figure(Month month, double daily_kWh, bool usable = true) {
  return {.month = month, .daily_average_kWh = daily_kWh, .usable = usable};
}

/// From January 2020 on; each month `level` of the year it lies in.
std::vector<MonthlyFigure> months(int count, double first_year, double second_year) {
  std::vector<MonthlyFigure> figures;
  Month month = std::chrono::year{2020} / 1;
  for (int i = 0; i < count; ++i, month = metering::next_month(month)) {
    figures.push_back(figure(month, i < 12 ? first_year : second_year));
  }
  return figures;
}

TEST(CompareYears, TheLastTwelveMonthsAgainstTheSameBefore) {
  const auto year = views::compare_years(months(24, 100.0, 110.0), {});
  ASSERT_TRUE(year && year->change);
  EXPECT_EQ(year->first, std::chrono::year{2021} / 1);
  EXPECT_EQ(year->months, 12);
  EXPECT_EQ(year->compared, 12);
  EXPECT_DOUBLE_EQ(year->energy_kWh, 365.0 * 110.0);
  EXPECT_NEAR(*year->change, 0.1, 0.001);
}

TEST(CompareYears, AMonthThatOneYearLacksCountsInNeither) {
  auto figures = months(24, 100.0, 110.0);
  figures[3].daily_average_kWh = 9000.0;
  figures[3].usable = false;
  const auto year = views::compare_years(figures, {});
  ASSERT_TRUE(year && year->change);
  EXPECT_EQ(year->months, 12);
  EXPECT_EQ(year->compared, 11);
  EXPECT_NEAR(*year->change, 0.1, 0.001);
}

TEST(CompareYears, AFewMonthsAreNoYear) {
  EXPECT_FALSE(views::compare_years(months(17, 100.0, 110.0), {})->change);
  EXPECT_TRUE(views::compare_years(months(18, 100.0, 110.0), {})->change);
  EXPECT_FALSE(views::compare_years({figure(std::chrono::year{2020} / 1, 5.0, false)}, {}));
}

TEST(CompareYears, AnotherUnitIsNoOtherUse) {
  const LevelChange change{.kind = LevelChangeKind::scale,
                           .since = std::chrono::year{2021} / 1,
                           .back_since = {},
                           .ratio = 1000.0,
                           .factor = 1000.0,
                           .z = 90.0,
                           .words = {}};
  EXPECT_FALSE(views::compare_years(months(24, 1.0, 1000.0), {change})->change);
}

views::MeterStory story(std::string label, double kWh, std::optional<double> change) {
  views::YearComparison year{.first = std::chrono::year{2021} / 1,
                             .last = std::chrono::year{2021} / 12,
                             .energy_kWh = kWh,
                             .months = 12,
                             .change = change,
                             .compared = change ? 12 : 0};
  return {.label = std::move(label), .year = year, .changes = {}, .unseen = {}, .base_share = NAN};
}

TEST(MetersFirstSentence, SaysWhatMattersMost) {
  std::vector<views::MeterStory> stories{story("Steam", 2e5, {}), story("Electricity", 3e5, {})};
  EXPECT_EQ(
      views::first_screen_of(stories).sentence,
      "Electricity: 300.0\u00a0MWh in 12 months to Dec 2021; Steam: 200.0\u00a0MWh in 12 months "
      "to Dec 2021.");
  stories[0].year->change = -0.02;
  stories[1].year->change = 0.12;
  stories[0].year->compared = stories[1].year->compared = 12;
  EXPECT_EQ(views::first_screen_of(stories).sentence,
            "Electricity used 12\u00a0% more in the 12 months to Dec 2021 than a year before. The "
            "other meter changed by less than 5\u00a0%.");
  stories[0].unseen = {.measured = 80.0, .forecast = {100.0, 95.0, 98.0, 100.0, 102.0, 105.0}};
  EXPECT_EQ(views::first_screen_of(stories).sentence,
            "Steam used 20\u00a0% less than its weather led to expect.");
  stories[1].changes = {{.kind = LevelChangeKind::level,
                         .since = std::chrono::year{2021} / 7,
                         .back_since = {},
                         .ratio = 1.35,
                         .factor = 1.3,
                         .z = 7.0,
                         .words = {}}};
  EXPECT_EQ(views::first_screen_of(stories).sentence,
            "Electricity has changed since Jul 2021: 35\u00a0% more in that month "
            "than in the same months before.");
}

TEST(MetersFirstSentence, AChangeThatHasEndedIsNotTheFirstThing) {
  std::vector<views::MeterStory> stories{story("Steam", 2e5, 0.01)};
  stories[0].changes = {{.kind = LevelChangeKind::level,
                         .since = std::chrono::year{2020} / 7,
                         .back_since = std::chrono::year{2020} / 10,
                         .ratio = 0.5,
                         .factor = 0.5,
                         .z = -9.0,
                         .words = {}}};
  EXPECT_EQ(views::first_screen_of(stories).sentence,
            "No meter used much more or less than a year before.");
  EXPECT_THAT(views::change_words("Steam", stories[0].changes[0]),
              HasSubstr("50\u00a0% less in that month than in the same months before; it is as "
                        "before since Oct 2020."));
}

TEST(MetersFirstNumbers, AreThreeWithSigns) {
  std::vector<views::MeterStory> stories{story("Steam", 2e5, -0.021),
                                         story("Electricity", 3e5, 0.12)};
  stories[1].base_share = 0.4;
  const auto numbers = views::first_screen_of(stories).numbers;
  ASSERT_EQ(numbers.size(), 3u);
  EXPECT_EQ(numbers[0].number, "+12.0\u00a0%");
  EXPECT_EQ(numbers[1].number, "−2.1\u00a0%");
  EXPECT_EQ(numbers[2].number, "300.0\u00a0MWh");
}

}  // namespace
}  // namespace recald::daemon::meters_report_test
