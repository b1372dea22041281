#include "adapters/report/meters_page.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "tests/adapters/report/page_text.hpp"
#include "tests/adapters/report/sample_meters.hpp"

namespace recald::report::meters_page_test {
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
  const std::size_t sentence = page.find("Steam has been at another level since Nov 2021");
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
                        "2021</td><td class=\"number\">4,307</td><td class=\"number\">−3.4"
                        "\u00a0%</td><td class=\"number\">172.4</td><td class=\"number\">41"
                        "\u00a0%</td>"));
}

TEST(MetersPage, ShowsTheRegressionWithItsUnits) {
  const std::string page = own_markup(render_meters(sample_meters()));
  EXPECT_THAT(page, HasSubstr("Heating, kWh/day per K"));
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
  EXPECT_EQ(root["shapes"][0]["kinds"][1]["kW"][12], 245.0);
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
}  // namespace recald::report::meters_page_test
