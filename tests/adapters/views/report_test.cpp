#include "adapters/views/calibration/report.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "adapters/views/frame/assets.hpp"
#include "adapters/views/frame/figure_data.hpp"
#include "adapters/views/frame/most_likely.hpp"
#include "core/display/unit.hpp"
#include "tests/adapters/views/page_text.hpp"
#include "tests/adapters/views/sample_report.hpp"

namespace recald::views {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;
using ::testing::Not;

constexpr std::string_view kHostile = "</script><script>alert(\"&'\")</script><!--";

/// The embedded data, found as a browser would: from the tag to the first closing script tag.
json embedded_data(const std::string& page) {
  constexpr std::string_view kOpen = "<script type=\"application/json\" id=\"report-data\">";
  const std::size_t begin = page.find(kOpen) + kOpen.size();
  return json::parse(page.substr(begin, page.find("</script>", begin) - begin));
}

TEST(Report, AnswersTheReadersQuestionsInTheirOrder) {
  const std::string page = render_report(sample_report());
  std::size_t last = 0;
  for (const std::string_view id : {"verdict", "data", "fit", "parameters", "peaks", "profile",
                                    "load", "not-known", "provenance"}) {
    const std::size_t at = page.find("<section id=\"" + std::string(id) + "\">");
    ASSERT_NE(at, std::string::npos) << id;
    EXPECT_GT(at, last) << id;
    last = at;
    EXPECT_THAT(page, HasSubstr("<a href=\"#" + std::string(id) + "\">"));
  }
  EXPECT_TRUE(page.starts_with("<!doctype html>\n<html lang=\"en\">"));
}

TEST(Report, BeginsWithWhatAClientUnderstands) {
  const std::string page = own_markup(render_report(sample_report()));
  const std::size_t sentence = page.find("The model uses 22\u00a0% too little chilled water");
  const std::size_t most_likely = page.find("What is missing is not known yet");
  const std::size_t number = page.find("<strong>−22.1\u00a0%</strong>");
  const std::size_t picture = page.find("data-figure=\"overview\"");
  const std::size_t guideline = page.find("ASHRAE Guideline 14");
  EXPECT_LT(sentence, most_likely);
  EXPECT_LT(most_likely, number);
  EXPECT_LT(number, picture);
  EXPECT_LT(picture, guideline);
  EXPECT_NE(guideline, std::string::npos);
}

TEST(Report, OfADesignLeavesOutWhatItsFolderDoesNotKnow) {
  const std::string page = own_markup(render_report(design_report()));
  for (const char* id : {"data", "peaks", "profile", "load"}) {
    EXPECT_THAT(page, Not(HasSubstr("<section id=\"" + std::string{id} + "\">")));
  }
  EXPECT_THAT(page, Not(HasSubstr("share of its intervals that are estimated")));
  EXPECT_THAT(page, HasSubstr("Month 36"));
  EXPECT_THAT(page, Not(HasSubstr("Dec 2")));
  EXPECT_THAT(page, HasSubstr("Steam peak: peak demand of each month, kW"));
  const json data = report_json(design_report());
  EXPECT_EQ(data["outputs"][1]["unit"], "kW");
  EXPECT_EQ(data["outputs"][1]["months"][35]["month"], "36");
  EXPECT_EQ(data["outputs"][1]["months"][0]["measured"],
            report_json(sample_report())["outputs"][1]["months"][0]["measured"]);
  EXPECT_TRUE(data["outputs"][1]["months"][0]["filled"].is_null());
  EXPECT_EQ(data["overview"][1]["unit"], "kW");
}

TEST(Report, ADiagnosisMadeLaterIsPutIntoThePage) {
  ReportData data = sample_report();
  const std::string page = render_report(data);
  const auto known = with_most_likely(page, data.provenance.data_revision,
                                      "Most likely: weekend operation <9 in 10>.");
  ASSERT_TRUE(known);
  EXPECT_THAT(*known, HasSubstr("Most likely: weekend operation &lt;9 in 10&gt;. "
                                "<a href=\"diagnosis.html\">"));
  EXPECT_THAT(*known, Not(HasSubstr("What is missing is not known yet")));
  // A page that was made with it is the same page.
  data.most_likely = "Most likely: weekend operation <9 in 10>.";
  EXPECT_EQ(*known, render_report(data));
}

TEST(Report, ADiagnosisOfOtherDataIsNotItsOwn) {
  ReportData data = sample_report();
  EXPECT_FALSE(with_most_likely(render_report(data), "another revision", "Most likely: a fan."));
  data.asks_for_diagnosis = false;
  EXPECT_FALSE(with_most_likely(render_report(data), data.provenance.data_revision, "A fan."));
}

TEST(Report, ShowsFiveWarningsBeforeMore) {
  ReportData data = sample_report();
  data.notices.assign(6, {Severity::info, "A note."});
  data.notices.push_back({Severity::failure, "The gravest."});
  const std::string page = own_markup(render_report(data));
  const std::size_t more = page.find("<summary>2 more</summary>");
  ASSERT_NE(more, std::string::npos);
  EXPECT_LT(page.find("The gravest."), page.find("A note."));
  EXPECT_EQ(occurrences(page.substr(0, more), "A note."), 4u);
  data.notices.resize(5);
  EXPECT_THAT(own_markup(render_report(data)), Not(HasSubstr(" more</summary>")));
}

TEST(Report, RanksWarningsByWhatTheyCost) {
  ReportData data = sample_report();
  data.notices = {{Severity::warning, "A note."},
                  {.severity = Severity::warning,
                   .sentence = "A few months.",
                   .details = "Which they are.",
                   .share = 0.1},
                  {.severity = Severity::warning, .sentence = "Most months.", .share = 0.8},
                  {Severity::failure, "The gravest."}};
  const std::string page = own_markup(render_report(data));
  EXPECT_LT(page.find("The gravest."), page.find("Most months."));
  EXPECT_LT(page.find("Most months."), page.find("A few months."));
  EXPECT_LT(page.find("A few months."), page.find("A note."));
  EXPECT_THAT(page, HasSubstr("<span>A few months.</span>\n<details><summary>Details</summary>\n"
                              "<p>Which they are.</p>\n</details>"));
}

TEST(Report, SaysWhatTheForecastMonthsCost) {
  ReportData data = sample_report();
  EXPECT_THAT(own_markup(render_report(data)), Not(HasSubstr("id=\"costs\"")));
  data.currency = "USD";
  const metering::Month january{std::chrono::year{2022} / 1};
  data.forecast_costs = {{.meter = "Steam",
                          .first = january,
                          .last = january + std::chrono::months{11},
                          .months = 12,
                          .money = ForecastSum{45'210.4, 43'900.0, 46'500.0, 45'980.0},
                          .emissions_t = ForecastSum{120.5, 117.0, 124.0, 122.5}}};
  const std::string page = own_markup(render_report(data));
  EXPECT_THAT(page, HasSubstr("Steam, 12 months, Jan 2022 to Dec 2022"));
  EXPECT_THAT(page, HasSubstr("<th scope=\"row\">Cost, USD</th><td class=\"number\">45,210</td><td "
                              "class=\"number\">43,900</td><td class=\"number\">46,500</td><td "
                              "class=\"number\">45,980</td>"));
  EXPECT_THAT(page, HasSubstr("<th scope=\"row\">CO2, t</th><td class=\"number\">120.5</td>"));
}

// A set-point of 24 °C is one of 75.2 °F, and its spread has no offset.
TEST(Report, ParametersAreSaidInIpWhereAsked) {
  ReportData data = sample_report();
  calibration::Summary& summary = data.parameters[0].summary;
  summary.unit = "degC";
  summary.mean = 24.0;
  summary.sd = 1.0;
  EXPECT_THAT(own_markup(render_report(data)), HasSubstr("(°C)"));
  data.units = display::UnitSystem::ip;
  const json ip = json::parse(figure_json(data));
  EXPECT_EQ(ip["parameters"][0]["unit"], "°F");
  EXPECT_NEAR(ip["parameters"][0]["mean"].get<double>(), 75.2, 1e-9);
  const std::string page = own_markup(render_report(data));
  EXPECT_THAT(page, HasSubstr("<td class=\"number\">75.20</td><td class=\"number\">1.800</td>"));
  EXPECT_THAT(page, Not(HasSubstr("°C")));
}

TEST(Report, SaysTheVerdictInWordsAndSigns) {
  const std::string page = render_report(sample_report());
  EXPECT_THAT(page, HasSubstr("2 of 3 outputs within the limits"));
  EXPECT_EQ(occurrences(page, "✓ Within limits"), 2u);
  EXPECT_EQ(occurrences(page, "✕ Outside limits"), 1u);
  EXPECT_LT(page.find("✕ Failure"), page.find("▲ Warning"));  // The gravest first.
}

TEST(Report, HoldsEveryFiguresNumbersAsATableWithoutJavaScript) {
  const ReportData data = sample_report();
  const std::string page = own_markup(render_report(data));
  // The overview; 3 months, 3 CV(RMSE), 3 parameters, 3 peaks, 3 day types, 3 loads.
  EXPECT_EQ(occurrences(page, "data-figure="), 19u);
  EXPECT_EQ(occurrences(page, "<summary>The data of this figure</summary>"), 19u);
  EXPECT_THAT(page, HasSubstr("<th scope=\"row\">Mar 2020</th><td>calibration</td>"));
  EXPECT_THAT(page, HasSubstr("<th scope=\"row\">Dec 2021</th><td>validation</td>"));
  EXPECT_THAT(page, HasSubstr("◆ different"));
  EXPECT_THAT(page, HasSubstr("△ the true peak may be higher"));
  EXPECT_THAT(page, HasSubstr("<th scope=\"row\">07–08 h</th>"));
  EXPECT_THAT(page, HasSubstr("<th scope=\"row\">2020-02-29</th>"));
  EXPECT_THAT(page, HasSubstr("41.0 % of the month is measured, 60 % are needed"));
  EXPECT_THAT(page, HasSubstr("The data narrowed this by"));
  EXPECT_EQ(occurrences(page, "Probability of each bar"), 3u);
}

TEST(Report, NamesBothSignsOfTheBias) {
  ReportData data;
  data.outputs.resize(1);
  data.outputs[0].label = "Steam";
  data.outputs[0].assessment.emplace().after.calibration = {0.062, -0.062, 0.149, 12};
  const std::string page = render_report(data);
  EXPECT_THAT(page, HasSubstr("<td class=\"number bad\">+6.2\u00a0%\u00a0✕</td>"));
  EXPECT_THAT(page, HasSubstr("<td class=\"number muted\">−6.2\u00a0%</td>"));
  EXPECT_THAT(page, HasSubstr("<td class=\"number good\">14.9\u00a0%\u00a0✓</td>"));
  EXPECT_THAT(page, HasSubstr("<td class=\"number\">–</td>"));  // No validation.
}

TEST(Report, CountsTheDrawsWithinTheLimit) {
  ReportData data;
  data.outputs.resize(1);
  data.outputs[0].assessment.emplace().draw_cvrmse_calibration = {0.10, 0.12, 0.15, 0.34};
  const std::string page = render_report(data);
  EXPECT_THAT(page,
              HasSubstr("Calibration months: median 13.5\u00a0%, 75\u00a0% of the draws within "
                        "15\u00a0%."));
  // The first of 24 bins of one percentage point each, by hand.
  EXPECT_THAT(page,
              HasSubstr("<th scope=\"row\">10.00\u00a0%</th><td class=\"number\">11.00\u00a0%</td>"
                        "<td class=\"number\">1</td>"));
}

TEST(Report, EscapesEveryTextFromOutside) {
  ReportData data = sample_report();
  const std::string hostile(kHostile);
  data.title = data.generated_at = hostile;
  data.site = {hostile, hostile, hostile};
  data.provenance.recald_version = data.provenance.data_revision = hostile;
  data.provenance.model_version = data.provenance.sampler = hostile;
  data.first.sentence = data.first.more = data.most_likely = hostile;
  data.first.numbers[0] = {hostile, hostile};
  data.headlines[0] = data.verdicts[0].output = data.verdicts[0].verdict.why = hostile;
  data.notices[0].sentence = data.not_known[0] = data.profile.check_sentence = hostile;
  data.findings[0].meter = data.findings[0].sentence = hostile;
  data.outputs[0].label = data.outputs[0].months[0].figure.unusable_because = hostile;
  data.parameters[0].label = hostile;
  data.parameters[0].summary.name = data.parameters[0].summary.unit = hostile;
  data.peaks[0].meter = hostile;
  data.profile.day_types[0].label = data.profile.day_types[0].parts[0].label = hostile;
  data.loads[0].meter = hostile;

  const std::string page = own_markup(render_report(data));

  EXPECT_EQ(occurrences(page, "<script"), 2u);
  EXPECT_EQ(occurrences(page, "</script>"), 2u);
  EXPECT_EQ(occurrences(page, "<!--"), 0u);
  EXPECT_EQ(embedded_data(page)["loads"][0]["label"], hostile);
}

TEST(Report, SurvivesBytesThatAreNotUtf8) {
  ReportData data = sample_report();
  data.parameters[0].label = "Caf\xE9";
  EXPECT_EQ(embedded_data(render_report(data))["parameters"][0]["label"], "Caf\xEF\xBF\xBD");
}

TEST(Report, AsksNothingOfTheNetwork) {
  const std::string page = render_report(sample_report());
  EXPECT_THAT(page, HasSubstr("content=\"default-src 'none'; script-src 'sha256-"));
  for (const std::string_view part :
       {"<link", "<iframe", "<img", "<object", "<base", " src=", "@import", "url(http", "fetch(",
        "XMLHttpRequest", "WebSocket"}) {
    EXPECT_THAT(own_markup(page), Not(HasSubstr(std::string(part))));
    EXPECT_THAT(std::string(assets().style), Not(HasSubstr(std::string(part))));
  }
  EXPECT_THAT(own_markup(page), Not(HasSubstr("://")));
  // In the script only the names of the SVG and XML namespaces look like addresses.
  for (const std::string_view scheme : {"http://", "https://", "//cdn", "ws://", "wss://"}) {
    for (std::size_t at = assets().script.find(scheme); at != std::string_view::npos;
         at = assets().script.find(scheme, at + 1)) {
      EXPECT_TRUE(assets().script.substr(at).starts_with("http://www.w3.org/"))
          << assets().script.substr(at, 80);
    }
  }
}

TEST(Report, EmbedsItsScriptUnbrokenAndWithinTheBudget) {
  const std::string page = render_report(ReportData{});
  EXPECT_THAT(page, HasSubstr("<script>" + std::string(assets().script) + "</script>"));
  EXPECT_THAT(std::string(assets().script), Not(HasSubstr("</script")));
  EXPECT_LE(assets().gzip_bytes, 500'000u);
  EXPECT_LE(own_markup(page).size(), 20'000u);
}

TEST(Report, IsTheSameBytesForTheSameData) {
  EXPECT_EQ(render_report(sample_report()), render_report(sample_report()));
}

TEST(Report, LeavesOutWhatIsNotThere) {
  ReportData data;
  data.title = "Readings only";
  const std::string page = own_markup(render_report(data));
  EXPECT_THAT(page, HasSubstr("<section id=\"provenance\">"));
  EXPECT_EQ(occurrences(page, "<section "), 1u);
  EXPECT_EQ(occurrences(page, "data-figure="), 0u);
}

TEST(Report, ShowsMeasurementsWhereThereIsNoModelYet) {
  const std::string page = own_markup(render_report(readings_only_report()));
  EXPECT_THAT(page, HasSubstr("There is no calibrated model yet: measurements only."));
  EXPECT_THAT(page, HasSubstr("Nothing was measured in these months."));
  EXPECT_THAT(page, HasSubstr("How much was used?"));
  EXPECT_THAT(page, HasSubstr("5 of 10 meter months are usable."));
  for (const std::string_view absent : {"Does the model follow", "Before and after", "model draws",
                                        "data-figure=\"cvrmse\"", "Guideline 14"}) {
    EXPECT_THAT(page, Not(HasSubstr(std::string(absent))));
  }
}

TEST(FigureJson, WritesAbsentAndNonFiniteNumbersAsNull) {
  ReportData data = sample_report();
  data.outputs[0].months[0].figure.daily_average_kWh = NAN;
  data.outputs[0].months[2].box.reset();
  data.parameters[0].summary.mean = INFINITY;
  data.parameters[0].draws.assign(5, NAN);
  data.loads[0].mean_kW[0] = NAN;
  data.profile.day_types[0].measured_mean_kW[3] = NAN;

  const std::string text = figure_json(data);
  const json root = json::parse(text);

  EXPECT_THAT(text, Not(HasSubstr("nan")));
  EXPECT_TRUE(root["outputs"][0]["months"][0]["measured"].is_null());
  EXPECT_TRUE(root["outputs"][0]["months"][2]["box"].is_null());
  EXPECT_TRUE(root["parameters"][0]["mean"].is_null());
  EXPECT_TRUE(root["parameters"][0]["density"].empty());
  EXPECT_TRUE(root["loads"][0]["kW"][0].is_null());
  EXPECT_TRUE(root["dayTypes"][0]["measured"][3].is_null());
}

TEST(FigureJson, RoundsToWhatAFigureCanShow) {
  ReportData data;
  data.loads = {{.meter = "Steam",
                 .first_day = metering::Day{std::chrono::year{2020}, std::chrono::month{1},
                                            std::chrono::day{1}},
                 .mean_kW = std::vector<float>(24, 123.456F),
                 .status = std::vector<HourStatus>(24, HourStatus::suspect)}};
  const json root = json::parse(figure_json(data));
  EXPECT_EQ(root["loads"][0]["kW"][23].dump(), "123.5");
  EXPECT_EQ(root["loads"][0]["status"], std::string(24, 's'));
  EXPECT_EQ(root["loads"][0]["firstDay"], "2020-01-01");
}

TEST(FigureJson, BinsThePosteriorInThirty) {
  const json parameter = json::parse(figure_json(sample_report()))["parameters"][2];
  EXPECT_EQ(parameter["density"].size(), 30u);
  double integral = 0.0;
  for (const double density : parameter["density"])
    integral += density * parameter["binWidth"].get<double>();
  EXPECT_NEAR(integral, 1.0, 1e-4);
  const json& corners = parameter["prior"];
  ASSERT_EQ(corners.size(), 3u);
  EXPECT_EQ(corners[0], json({4.2, 0.0}));
  EXPECT_EQ(corners[1][0], 14.0);
  EXPECT_NEAR(corners[1][1].get<double>(), 2.0 / (16.8 - 4.2), 1e-4);
  EXPECT_EQ(corners[2], json({16.8, 0.0}));
}

}  // namespace
}  // namespace recald::views
