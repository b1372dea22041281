#include "adapters/views/diagnosis/diagnosis_page.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "adapters/views/diagnosis/diagnosis_sections.hpp"
#include "adapters/views/frame/assets.hpp"
#include "tests/adapters/views/page_text.hpp"
#include "tests/adapters/views/sample_diagnosis.hpp"

namespace recald::views {
namespace {

using nlohmann::json;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

std::string markup_of(const DiagnosisData& data) { return own_markup(render_diagnosis(data)); }

TEST(DiagnosisPage, AnswersTheReadersQuestionsInTheirOrder) {
  const std::string page = render_diagnosis(sample_diagnosis());
  std::size_t last = 0;
  for (const std::string_view id : {"outcome", "located", "maps", "candidates", "gap", "signature",
                                    "not-identifiable", "base", "provenance"}) {
    const std::size_t at = page.find("<section id=\"" + std::string(id) + "\">");
    ASSERT_NE(at, std::string::npos) << id;
    EXPECT_GT(at, last) << id;
    last = at;
    EXPECT_THAT(page, HasSubstr("<a href=\"#" + std::string(id) + "\">"));
  }
}

TEST(DiagnosisPage, SaysWhatIsMissingSinceWhenAndHowMuch) {
  const std::string page = markup_of(sample_diagnosis());
  EXPECT_THAT(page, HasSubstr("✓ Named"));
  EXPECT_THAT(page, HasSubstr("Missing in the model: &quot;Night set-back missing&quot;."));
  EXPECT_THAT(page, HasSubstr("Probability 93.0\u00a0%. Since about 12 Mar 2021"));
  EXPECT_THAT(page, HasSubstr("<th scope=\"row\">Steam</th><td class=\"number\">+4,230 kWh</td>"));
  EXPECT_THAT(page, HasSubstr("<th scope=\"row\">Chilled water</th><td class=\"number\">−310 kWh"));
  EXPECT_THAT(page, HasSubstr("14.2\u00a0% more than the model (±\u00a03.0\u00a0%)"));
  EXPECT_THAT(page, HasSubstr("6.1\u00a0% less than the model"));
  EXPECT_THAT(page, HasSubstr("The months kept back confirm it"));
  EXPECT_THAT(page, Not(HasSubstr("Not confirmed")));
}

TEST(DiagnosisPage, ShowsByWhichFiguresOfTheMetersAnEffectIsSeen) {
  DiagnosisData data = sample_diagnosis();
  const std::string_view heading = "What speaks for them";
  EXPECT_THAT(markup_of(data), Not(HasSubstr(heading)));
  data.signs = {{"Night set-back missing", "Heat", "Nights, January", 0.141, -0.01}};
  EXPECT_THAT(markup_of(data),
              AllOf(HasSubstr(heading),
                    HasSubstr("<th scope=\"row\">Night set-back missing</th><td>Heat</td>"
                              "<td>Nights, January</td><td class=\"number\">+14.1\u00a0%</td>"
                              "<td class=\"number\">−1.0\u00a0%</td>")));
}

TEST(DiagnosisPage, HoldsEveryFiguresNumbersAsATableWithoutJavaScript) {
  const std::string page = markup_of(sample_diagnosis());
  // A week and a temperature map a meter, candidates, three measures, a signature a meter.
  EXPECT_EQ(occurrences(page, "data-figure="), 13u);
  EXPECT_EQ(occurrences(page, "<summary>The data of this figure</summary>"), 13u);
  EXPECT_THAT(page, HasSubstr("<th scope=\"col\" class=\"number\">Dec 2022, kept back</th>"));
  EXPECT_THAT(page, HasSubstr("Before</th></tr>\n<tr><th scope=\"row\">Mon 00–04 h</th>"));
  EXPECT_THAT(page, HasSubstr("−10 to −5 °C"));
  EXPECT_THAT(page, HasSubstr("Room temperature of two winter nights"));
  EXPECT_THAT(page, HasSubstr("41 kW (30 kW to 52 kW)"));
}

TEST(DiagnosisPage, GivesTheFiguresTheirNumbers) {
  const json data = json::parse(diagnosis_figure_json(sample_diagnosis()));
  ASSERT_EQ(data["maps"].size(), 3u);
  EXPECT_EQ(data["maps"][1]["before"]["month"].size(), 42u);
  EXPECT_EQ(data["maps"][1]["before"]["month"][0].size(), 24u);
  EXPECT_TRUE(data["maps"][1]["before"]["month"][0][9].is_null());  // not read in that month
  EXPECT_EQ(data["maps"][1]["after"]["temperature"].size(), 6u);
  EXPECT_EQ(data["uses"][23], "kept");
  EXPECT_EQ(data["uses"][2], "choose");
  EXPECT_EQ(data["candidates"][1]["kind"], "unknown");
  EXPECT_EQ(data["candidates"][3]["kind"], "none");
  EXPECT_EQ(data["steps"]["labels"].size(), 2u);
  EXPECT_NEAR(data["steps"]["measures"][0]["meters"][1]["values"][1].get<double>(), 0.081, 1e-9);
  // The log score is a gain on the model as drawn.
  EXPECT_EQ(data["steps"]["measures"][2]["meters"][1]["values"][0], 0.0);
  EXPECT_NEAR(data["steps"]["measures"][2]["meters"][1]["values"][1].get<double>(), 51.5, 1e-9);
  EXPECT_EQ(data["signatures"][1]["residual"]["week"].size(), 42u);
  EXPECT_EQ(data["temperatureLimits"].size(), 10u);
}

TEST(DiagnosisPage, SaysTimesWhereAPercentageWouldSayNothing) {
  DiagnosisData data = sample_diagnosis();
  data.located[0].share = 146.3;
  const std::string page = markup_of(data);
  EXPECT_THAT(page, HasSubstr("147.3 times what the model says"));
}

// One odd cell must not bleach the rest, and both sides must be read by the same eye.
TEST(ColourScale, HoldsNearlyAllCellsOfBothMaps) {
  MeterMaps maps{"Steam", "100 kW", {}, {}};
  maps.before.by_month = Eigen::ArrayXXd::Constant(42, 10, 0.12);
  maps.before.by_month(0, 0) = -5.0;
  EXPECT_EQ(colour_scale(maps), 0.15);
  maps.after = diagnosis::ResidualMap{Eigen::ArrayXXd::Constant(42, 10, -0.35), {}};
  EXPECT_EQ(colour_scale(maps), 0.4);
  maps.after->by_month.setConstant(7.0);
  EXPECT_EQ(colour_scale(maps), 1.0);
  maps.after.reset();
  maps.before.by_month.setConstant(std::nan(""));
  EXPECT_EQ(colour_scale(maps), 0.05);
}

TEST(DiagnosisPage, SaysInRedWordsThatNothingWasConfirmed) {
  const std::string page = markup_of(unconfirmed_diagnosis());
  EXPECT_THAT(page, HasSubstr("✕ Not confirmed"));
  EXPECT_THAT(page, HasSubstr("<p class=\"headline bad\">Not confirmed:"));
  EXPECT_THAT(page, HasSubstr("<p class=\"bad\">Not confirmed: on the months kept back"));
  EXPECT_THAT(page, HasSubstr("✕ Tried and withdrawn"));
  EXPECT_THAT(page, Not(HasSubstr("✓ Added to the model")));
  EXPECT_THAT(page, Not(HasSubstr("confirm it:")));
}

TEST(DiagnosisPage, EscapesEveryTextFromOutside) {
  const std::string page = markup_of(unconfirmed_diagnosis());
  EXPECT_EQ(occurrences(page, "<script"), 2u);
  EXPECT_EQ(occurrences(page, "</script>"), 2u);
  EXPECT_EQ(occurrences(page, "<!--"), 0u);
}

TEST(DiagnosisPage, SurvivesBytesThatAreNotUtf8) {
  DiagnosisData data = sample_diagnosis();
  data.candidates[0].label = "Caf\xE9";
  const json figures = json::parse(diagnosis_figure_json(data));
  EXPECT_EQ(figures["candidates"][0]["label"], "Caf\xEF\xBF\xBD");
}

TEST(DiagnosisPage, AsksNothingOfTheNetwork) {
  const std::string page = render_diagnosis(sample_diagnosis());
  EXPECT_THAT(page, HasSubstr("content=\"default-src 'none'; script-src 'sha256-"));
  for (const std::string_view part : {"<link", "<iframe", "<img", " src=", "@import", "://"}) {
    EXPECT_THAT(own_markup(page), Not(HasSubstr(std::string(part))));
  }
}

TEST(DiagnosisPage, ShowsAMeterWithoutReadingsOnTheMonthsKeptBackAsADash) {
  const json data = json::parse(diagnosis_figure_json(unconfirmed_diagnosis()));
  EXPECT_TRUE(data["steps"]["measures"][0]["meters"][2]["values"][0].is_null());
  EXPECT_THAT(markup_of(unconfirmed_diagnosis()),
              HasSubstr("<th scope=\"row\">as drawn</th><td class=\"number\">–</td>"));
}

TEST(DiagnosisPage, SaysHonestlyThatThereIsNothing) {
  const std::string page = markup_of(empty_handed_diagnosis());
  EXPECT_THAT(page, HasSubstr("○ Nothing named"));
  EXPECT_THAT(page, HasSubstr("Nowhere beyond chance"));
  EXPECT_THAT(page, HasSubstr("No month was kept back: the record is too short for it."));
  for (const std::string_view absent :
       {"<section id=\"gap\">", "<section id=\"signature\">", "href=\"#gap\"",
        "before and after</h3>", "Added to the model", "What would tell them apart"}) {
    EXPECT_THAT(page, Not(HasSubstr(std::string(absent))));
  }
}

TEST(DiagnosisPage, IsAPageEvenOfNothingAtAll) {
  const std::string page = markup_of(DiagnosisData{});
  EXPECT_THAT(page, HasSubstr("<section id=\"outcome\">"));
  EXPECT_EQ(occurrences(page, "data-figure="), 0u);
  EXPECT_TRUE(json::parse(diagnosis_figure_json(DiagnosisData{}))["steps"].is_null());
}

TEST(DiagnosisPage, IsTheSameBytesForTheSameData) {
  EXPECT_EQ(render_diagnosis(sample_diagnosis()), render_diagnosis(sample_diagnosis()));
}

}  // namespace
}  // namespace recald::views
