#include "adapters/views/meters/meters_page.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "core/display/unit.hpp"
#include "tests/adapters/views/page_text.hpp"
#include "tests/adapters/views/sample_meters.hpp"

namespace recald::views::meters_page_test {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;
using ::testing::Not;

TEST(MetersPage, AnswersTheReadersQuestionsInTheirOrder) {
  const std::string page = render_meters(sample_meters());
  std::size_t last = 0;
  for (const std::string_view id : {"meters", "level-changes", "months", "temperature", "days",
                                    "peaks", "load", "data", "provenance"}) {
    const std::size_t at = page.find("<section id=\"" + std::string(id) + "\">");
    ASSERT_NE(at, std::string::npos) << id;
    EXPECT_GT(at, last) << id;
    last = at;
    EXPECT_THAT(page, HasSubstr("<a href=\"#" + std::string(id) + "\">"));
  }
}

TEST(MetersPage, BeginsWithASentenceNumbersAndAPicture) {
  const std::string page = own_markup(render_meters(sample_meters()));
  const std::size_t sentence = page.find("Steam has changed since Nov 2021");
  const std::size_t number = page.find("<strong>−12.4\u00a0%</strong>");
  const std::size_t picture = page.find("data-figure=\"overview\"");
  const std::size_t table = page.find("The meters at a glance");
  EXPECT_LT(sentence, number);
  EXPECT_LT(number, picture);
  EXPECT_LT(picture, table);
  EXPECT_NE(table, std::string::npos);
  EXPECT_EQ(occurrences(page, "<strong>"), 3u);
}

TEST(MetersPage, ShowsBaseLoadYearAndPeakOfEachMeter) {
  const std::string page = own_markup(render_meters(sample_meters()));
  EXPECT_THAT(page,
              HasSubstr("<th scope=\"row\">Electricity</th><td class=\"nowrap\">Jan 2021 to Dec "
                        "2021</td><td class=\"number\">4,307\u00a0MWh</td><td class=\"number\">−3.4"
                        "\u00a0%</td><td class=\"number\">172.4\u00a0kW</td><td class=\"number\">41"
                        "\u00a0%</td>"));
}

TEST(MetersPage, ShowsTheRegressionWithItsUnits) {
  const std::string page = own_markup(render_meters(sample_meters()));
  EXPECT_THAT(page, HasSubstr("Heating, a day per degree"));
  EXPECT_THAT(page, HasSubstr(">Chilled water: kWh, °C</th>"));
  EXPECT_THAT(
      page, HasSubstr("<th scope=\"row\">Saturdays, Sundays and holidays</th><td class=\"number\">"
                      "80.00</td><td class=\"number\">12.00</td><td class=\"number\">15.0</td>"
                      "<td class=\"number\">–</td><td class=\"number\">–</td>"));
  EXPECT_EQ(occurrences(page, "data-figure=\"temperature\""), 2u);
  EXPECT_THAT(page, HasSubstr("too close together for a slope"));
  EXPECT_THAT(page, HasSubstr("11 of 12 months lay inside the 90\u00a0% band"));
}

TEST(MetersPage, HoldsEveryFiguresNumbersAsATable) {
  const std::string page = own_markup(render_meters(sample_meters()));
  // The overview; months, days, peaks and loads of three meters; two against the temperature.
  EXPECT_EQ(occurrences(page, "data-figure="), 15u);
  EXPECT_EQ(occurrences(page, "<summary>The data of this figure</summary>"), 15u);
  EXPECT_THAT(page,
              HasSubstr("<th scope=\"row\">2019-01-02</th><td class=\"nowrap\">Working days"));
}

TEST(MetersPage, ForecastsStandOnlyWhereThereAreAny) {
  MetersData data = sample_meters();
  const std::string page = own_markup(render_meters(data));
  EXPECT_EQ(occurrences(page, "Forecast, kWh/day"), 2u);
  for (OutputResult& output : data.common.outputs) {
    for (OutputMonth& month : output.months) month.forecast.reset();
  }
  for (MeterPart& meter : data.meters) {
    meter.temperature.reset();
    meter.no_temperature_because.clear();
  }
  data.first = {};
  std::string bare = own_markup(render_meters(data));
  bare.erase(bare.find("<script type=\"application/json\""));
  for (const std::string_view absent : {"orecast", "id=\"temperature\"", "band"}) {
    EXPECT_EQ(bare.find(absent), std::string::npos) << absent;
  }
}

TEST(MetersPage, AYoungSiteSaysWhatItCannotSayYet) {
  const std::string page = own_markup(render_meters(young_meters()));
  EXPECT_THAT(page, HasSubstr("no meter has more than one year yet"));
  EXPECT_THAT(page, HasSubstr("2 more meters; months.csv"));
  EXPECT_EQ(occurrences(page, "data-figure=\"dayprofile\""), 0u);
}

TEST(MetersPage, EscapesEveryTextFromOutside) {
  MetersData data = sample_meters();
  const std::string hostile = "</script><script>alert(\"&'\")</script><!--";
  data.common.outputs[0].label = data.first.sentence = data.first.more = hostile;
  data.first.numbers[0] = {hostile, hostile};
  data.changes[0] = data.meters[2].no_temperature_because = data.left_out = hostile;
  data.meters[0].temperature->sentence = data.meters[0].temperature->trust = hostile;
  data.meters[0].temperature->rows[0].days = hostile;
  const std::string page = own_markup(render_meters(data));
  EXPECT_EQ(occurrences(page, "<script"), 2u);
  EXPECT_EQ(occurrences(page, "</script>"), 2u);
  EXPECT_EQ(occurrences(page, "<!--"), 0u);
}

TEST(MetersFigures, HaveTheDaysAndTheLineOfTheRegression) {
  const json root = json::parse(meters_figure_json(sample_meters()));
  ASSERT_EQ(root["temperatures"].size(), 3u);
  EXPECT_EQ(root["temperatures"][0]["days"].size(), 730u);
  EXPECT_EQ(root["temperatures"][0]["days"][400]["unseen"], true);
  EXPECT_EQ(root["temperatures"][0]["lines"][1]["points"][1], json({15.0, 80.0}));
  EXPECT_TRUE(root["temperatures"][2]["days"].empty());
  EXPECT_EQ(root["shapes"][0]["base"], 172.4);
  EXPECT_EQ(root["shapes"][0]["kinds"][1]["load"][12], 245.0);
}

TEST(MetersPage, SaysWhatEachYearAndMonthCost) {
  MetersData data = sample_meters();
  data.common.currency = "EUR";
  const metering::Month december{std::chrono::year{2020} / 12};
  data.common.costs = {
      {"Electricity",
       {{december, {.energy = 10'000.4, .demand = 900.0, .emissions_kg = 20'000.0}},
        {december + std::chrono::months{1}, {.energy = 500.0, .demand = {}, .emissions_kg = {}}},
        {december + std::chrono::months{2},
         {.energy = 700.0, .demand = 40.0, .emissions_kg = {}}}}}};
  const std::string page = own_markup(render_meters(data));
  EXPECT_THAT(page, HasSubstr("<th scope=\"row\">2020</th><td class=\"number\">1</td><td "
                              "class=\"number\">10,000</td><td class=\"number\">900</td><td "
                              "class=\"number\">20.00</td>"));
  EXPECT_THAT(page, HasSubstr("<th scope=\"row\">2021</th><td class=\"number\">2</td><td "
                              "class=\"number\">1,200</td><td class=\"number\">40</td><td "
                              "class=\"number\">–</td>"));
  EXPECT_THAT(page, HasSubstr("<th scope=\"row\">Jan 2021</th><td class=\"number\">500</td>"));
  EXPECT_THAT(own_markup(render_meters(sample_meters())), Not(HasSubstr("id=\"costs\"")));
}

// The same meters in SI and IP: each number is the other's times the factor of its unit.
TEST(MetersPage, SpeaksIpWhereAsked) {
  MetersData data = sample_meters();
  const json si = json::parse(meters_figure_json(data));
  data.common.units = display::UnitSystem::ip;
  const auto as = display::meter_units(display::UnitSystem::ip, metering::Utility::chilled_water);
  for (OutputResult& output : data.common.outputs) output.units = as;
  for (PeakSeries& series : data.common.peaks) series.units = as;
  for (LoadGrid& load : data.common.loads) load.units = as;
  for (MeterPart& meter : data.meters) {
    // Finished where they are written.
    meter.no_temperature_because.clear();
    if (meter.temperature) meter.temperature->sentence.clear();
  }
  const json ip = json::parse(meters_figure_json(data));
  constexpr double kTon_kW = 3.516853;
  const auto ratio = [&](const json::json_pointer& at) {
    return ip.at(at).get<double>() / si.at(at).get<double>();
  };
  for (const char* at :
       {"/outputs/0/months/3/measured", "/overview/0/months/35/band/1", "/peaks/0/months/3/peak",
        "/shapes/0/base", "/temperatures/0/days/400/energy"}) {
    EXPECT_NEAR(ratio(json::json_pointer{at}), 1.0 / kTon_kW, 1e-3) << at;
  }
  EXPECT_EQ(ip["outputs"][0]["unit"], "ton-hours/day");
  EXPECT_EQ(ip["loads"][0]["kW"], si["loads"][0]["kW"]);  // a file of the hours stays in kW
  EXPECT_NEAR(ip["loads"][0]["unitsPerKW"].get<double>(), 1.0 / kTon_kW, 1e-6);
  EXPECT_EQ(ip["temperatures"][0]["lines"][1]["points"][1][0], 59.0);  // 15 °C
  const std::string page = own_markup(render_meters(data));
  EXPECT_THAT(page, Not(HasSubstr("°C")));
  EXPECT_THAT(page, Not(HasSubstr("kWh")));
  EXPECT_THAT(page, HasSubstr(">Chilled water: ton-hours, °F</th>"));
  EXPECT_THAT(page, HasSubstr("1,224,675\u00a0ton-hours"));  // 4,307 MWh
}

TEST(MetersFigures, TheOverviewHasNoValueOfAnUnusableMonth) {
  const json root = json::parse(meters_figure_json(sample_meters()));
  ASSERT_EQ(root["overview"].size(), 3u);
  EXPECT_TRUE(root["overview"][1]["months"][14]["measured"].is_null());
  EXPECT_EQ(root["overview"][1]["months"][14]["band"].size(), 3u);
  EXPECT_TRUE(root["overview"][2]["months"][0]["band"].is_null());
  EXPECT_EQ(root["overview"][0]["months"][35]["role"], "validation");
}

}  // namespace
}  // namespace recald::views::meters_page_test
