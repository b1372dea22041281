#include "adapters/views/diagnosis/diagnosis_files.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "adapters/views/diagnosis/diagnosis_page.hpp"
#include "adapters/views/diagnosis/diagnosis_report.hpp"
#include "adapters/views/diagnosis/diagnosis_words.hpp"
#include "core/diagnosis/effect_posterior.hpp"
#include "core/diagnosis/next_version.hpp"
#include "tests/adapters/views/made_up_diagnosis.hpp"

namespace recald::views {
namespace {

using diagnosis::Diagnosis;
using diagnosis::ModelGap;
using Json = nlohmann::json;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;
using ::testing::StartsWith;

class DiagnosisFiles : public ::testing::Test {
 protected:
  [[nodiscard]] Json json_of(const Diagnosis& d, const std::vector<ModelGap>& others = {}) const {
    RunFacts facts;
    facts.recald_version = "0.1.0";
    facts.data_revision = "9f2c";
    facts.model_version = "hourly-3b1c";
    facts.seed = 7;
    return Json::parse(diagnosis_json(d, site_, facts, others));
  }
  [[nodiscard]] DiagnosisData page_data(const Diagnosis& d,
                                        const std::vector<ModelGap>& others = {}) const {
    return diagnosis_report_of({.id = "depot", .name = "Depot", .time_zone = "UTC"}, d, site_,
                               RunFacts{}, "2023-01-05", others);
  }

  diagnosis::SiteProblem site_ = recald::testing::made_up_site();
};

TEST_F(DiagnosisFiles, HasEveryEntryOfTheContract) {
  const Json result = json_of(recald::testing::one_named(site_));
  for (const char* entry : {"outcome", "why", "located", "candidates", "added", "additions", "gap",
                            "base_fit", "not_identifiable_here", "warnings", "seed",
                            "recald_version", "data_revision", "model_version", "wall_s"}) {
    EXPECT_TRUE(result.contains(entry)) << entry;
  }
  EXPECT_EQ(result["outcome"], "named");
  EXPECT_EQ(result["added"], Json::array({"steam_trap_leak"}));
  EXPECT_EQ(result["located"][0]["meter"], "steam");
  EXPECT_EQ(result["gap"]["hourly"]["before"]["steam"]["cvrmse_daily"], 0.14);
  EXPECT_EQ(result["gap"]["hourly"]["after"]["steam"]["cvrmse_daily"], 0.08);
  EXPECT_EQ(result["gap"]["hourly"]["log_score_change"]["steam"]["sum"], 40.0);
}

TEST_F(DiagnosisFiles, WritesAnAdditionWithItsPosteriorAndDates) {
  const Json addition = json_of(recald::testing::one_named(site_))["additions"][0];
  EXPECT_EQ(addition["effect"], "steam_trap_leak");
  EXPECT_EQ(addition["key"], "steam_trap_leak@");
  EXPECT_EQ(addition["status"], "added");
  EXPECT_EQ(addition["monthly_kWh"]["steam"], 2920.0);
  const Json& loss = addition["parameters"][0];
  EXPECT_EQ(loss["mode"], 4.0);
  EXPECT_EQ(loss["sd"], 0.5);
  EXPECT_NEAR(loss["q05"].get<double>(), 3.1, 1e-9);
  EXPECT_NEAR(loss["q50"].get<double>(), 4.0, 1e-9);
  EXPECT_NEAR(loss["q95"].get<double>(), 4.9, 1e-9);
  EXPECT_EQ(addition["parameters"][1]["date"], "2021-03-01");  // 59 days after 1 January
  EXPECT_EQ(addition["parameters"][1]["date_q95"], "2021-03-06");
}

TEST_F(DiagnosisFiles, WritesCandidatesWithTheirPosteriors) {
  const Diagnosis d = recald::testing::nothing_named(site_);
  const Json candidates = json_of(d)["candidates"];
  ASSERT_EQ(candidates.size(), 4u);
  EXPECT_EQ(candidates[0]["effect"], "none");
  EXPECT_FALSE(candidates[0].contains("parameters"));
  const Json& leak = candidates[1];
  const Prior& prior = d.candidates[0].parameters[0].prior;
  EXPECT_NEAR(leak["parameters"][0]["mode"].get<double>(), prior.at_score(0.5).value, 1e-9);
  EXPECT_NEAR(leak["parameters"][0]["q95"].get<double>(),
              prior.at_score(0.5 + 1.6448536 * 0.2).value, 1e-6);
  EXPECT_NEAR(leak["parameters"][0]["sd"].get<double>(), prior.at_score(0.5).derivative * 0.2,
              1e-9);
  EXPECT_EQ(leak["confusable_with"].size(), leak["separated_by"].size());
}

TEST_F(DiagnosisFiles, TakesBackWhatWasNotConfirmed) {
  const Json result = json_of(recald::testing::one_taken_back(site_));
  EXPECT_EQ(result["outcome"], "unknown");
  EXPECT_TRUE(result["added"].empty());
  EXPECT_EQ(result["additions"][0]["status"], "tried and withdrawn");
  EXPECT_THAT(result["why"].get<std::string>(), HasSubstr("does not improve the prediction"));
  EXPECT_FALSE(result["gap"]["hourly"]["confirmed"].get<bool>());
}

TEST_F(DiagnosisFiles, NamesEachEffectThatCannotBeSeenOnce) {
  Diagnosis d = recald::testing::nothing_named(site_);
  std::erase_if(d.passes[0].naming.probabilities,
                [](const auto& p) { return p.effect == "server_room"; });
  // The server room stands twice, always and since a day; the leak was weighed.
  d.candidates.push_back(recald::testing::candidate_of(site_, "server_room", true));
  const Json list = json_of(d)["not_identifiable_here"];
  ASSERT_EQ(list.size(), 2u);
  EXPECT_EQ(list[0]["effect"], "wind_infiltration");
  EXPECT_EQ(list[1]["effect"], "server_room");
  EXPECT_THAT(list[1]["why"].get<std::string>(), HasSubstr("would not show"));
}

TEST_F(DiagnosisFiles, SaysNothingOfWhatWasNotAskedBesideAnAssumedEffect) {
  Diagnosis d = recald::testing::one_named(site_);
  d.passes[0].naming.probabilities = {{"steam_trap_leak", -1, 1.0, 0}};
  const Json list = json_of(d)["not_identifiable_here"];
  ASSERT_EQ(list.size(), 1u);
  EXPECT_EQ(list[0]["effect"], "wind_infiltration");
}

TEST_F(DiagnosisFiles, GivesTheProbabilityOfWhatWasNotFitted) {
  Diagnosis d = recald::testing::nothing_named(site_);
  d.passes[0].naming.probabilities.push_back({"plug_growth", -1, 0.02, {}});
  const Json candidates = json_of(d)["candidates"];
  ASSERT_EQ(candidates.size(), 5u);
  EXPECT_EQ(candidates[4]["effect"], "plug_growth");
  EXPECT_EQ(candidates[4]["probability"], 0.02);
  EXPECT_FALSE(candidates[4].contains("evidence_gain"));
}

// Odds of nine against even: 0.7 of none becomes 6.3 / 6.6.
TEST_F(DiagnosisFiles, GivesProbabilitiesForOtherPriors) {
  Diagnosis d = recald::testing::nothing_named(site_);
  d.passes[0].naming.probabilities = {{"none", -1, 0.7, {}}, {"steam_trap_leak", -1, 0.3, {}}};
  const Json even = json_of(d);
  EXPECT_EQ(even["prior_none"], 0.5);
  const Json& leak = even["candidates"][1];
  EXPECT_EQ(leak["probability_at_prior_none"]["0.5"], 0.3);
  EXPECT_NEAR(leak["probability_at_prior_none"]["0.9"].get<double>(), 0.3 / 6.6, 1e-12);
  EXPECT_NEAR(page_data(d).candidates[0].if_nine_in_ten_lack_nothing, 6.3 / 6.6, 1e-12);
  d.passes[0].naming.prior_none = 0.9;
  EXPECT_NEAR(json_of(d)["candidates"][1]["probability_at_prior_none"]["0.5"].get<double>(),
              0.3 / (0.3 + 0.7 / 9.0), 1e-12);
}

TEST_F(DiagnosisFiles, GivesOtherModelsAnEntryOfTheirOwn) {
  const ModelGap epc{.model = ModelKind::epc,
                     .outputs = {"steam_daily_kWh"},
                     .before = {{0.02, 0.12, -30.0, 0.5}},
                     .after = {{0.01, 0.07, std::nan(""), 0.4}},
                     .change = {{{3.0, 1.5}, {-0.02, 0.01}, {-0.09, -0.004}}}};
  const Json gap = json_of(recald::testing::one_named(site_), {epc})["gap"];
  EXPECT_TRUE(gap.contains("hourly"));
  EXPECT_EQ(gap["epc"]["before"]["steam_daily_kWh"]["cvrmse"], 0.12);
  EXPECT_TRUE(gap["epc"]["after"]["steam_daily_kWh"]["log_score"].is_null());
  const Json& change = gap["epc"]["change"]["steam_daily_kWh"];
  EXPECT_EQ(change["log_score"]["sum"], 3.0);
  EXPECT_EQ(change["log_score"]["se"], 1.5);
  EXPECT_EQ(change["nmbe_size"]["q95"], 0.01);
  EXPECT_EQ(change["cvrmse"]["q05"], -0.09);
  EXPECT_THAT(
      diagnosis_words(recald::testing::one_named(site_), site_, {epc}),
      HasSubstr(
          "Scatter of months in the monthly model: Steam, daily mean 12.0 % before, 7.0 % after "
          "(90 % interval of the change: -9.0 to -0.4)."));
  EXPECT_TRUE(json_of(recald::testing::nothing_named(site_))["gap"].is_null());
  EXPECT_THAT(
      render_diagnosis(page_data(recald::testing::one_named(site_), {epc})),
      HasSubstr("Monthly model: Steam, daily mean</th><td class=\"number\">12.0\u00a0%</td>"));
}

TEST_F(DiagnosisFiles, TheNextVersionCarriesTheSamePosterior) {
  const Diagnosis d = recald::testing::one_named(site_);
  diagnosis::ModelVersion parent;
  parent.version = "drawings";
  const auto next = diagnosis::next_version(
      d, site_, parent,
      {.data_revision = "", .catalogue_version = "", .created_at = "2023-01-05T00:00:00Z"});
  ASSERT_EQ(next.effects.size(), 1u);
  const diagnosis::AddedEffect& leak = next.effects[0];
  EXPECT_EQ(leak.parameters[0].draws.size(), 101u);
  EXPECT_NEAR(leak.parameters[0].mean, 4.0, 1e-9);
  EXPECT_NEAR(leak.parameters[0].q95, 4.9, 1e-9);
  ASSERT_TRUE(leak.from.has_value());
  EXPECT_EQ(metering::to_string(*leak.from), "2021-03-01");
  EXPECT_FALSE(leak.to.has_value());
  EXPECT_EQ(leak.months_used.size(), 6u);
  EXPECT_EQ(leak.rivals.size(), 3u);
}

TEST_F(DiagnosisFiles, WordsSayWhatIsMissingSinceWhenAndHowMuch) {
  const std::string words = diagnosis_words(recald::testing::one_named(site_), site_);
  EXPECT_THAT(words, HasSubstr("Outcome: named. Missing from the model: \"Steam or heat leaks in"));
  EXPECT_THAT(words, HasSubstr("Probability 93.0\u00a0%. Since about 1 Mar 2021 (90 %: "));
  EXPECT_THAT(words, HasSubstr("about 2,920 kWh a month more at Steam."));
  EXPECT_THAT(words, HasSubstr("in the 2 held-out months"));
  EXPECT_THAT(words, Not(HasSubstr("Chilled water, ")));  // touched by next to nothing
}

TEST_F(DiagnosisFiles, WordsSayWhatItCostsWherePricesAreKnown) {
  EXPECT_THAT(diagnosis_words(recald::testing::one_named(site_), site_),
              Not(HasSubstr("It costs")));
  site_.currency = "EUR";
  site_.meters[1].price_per_kWh = 0.10;
  site_.meters[1].emissions_kg_per_kWh = 0.25;
  EXPECT_THAT(diagnosis_words(recald::testing::one_named(site_), site_),
              HasSubstr("It costs about 3,504 EUR and 8.8 t of CO2 a year."));
}

TEST_F(DiagnosisFiles, WordsDoNotContradictWhatWasTakenBack) {
  const Diagnosis d = recald::testing::one_taken_back(site_);
  const std::string words = diagnosis_words(d, site_);
  EXPECT_THAT(words, HasSubstr("Outcome: unknown. Not confirmed: \"Steam or heat leaks in the "
                               "pipes\" was tried and withdrawn."));
  EXPECT_THAT(words, HasSubstr("Tried and withdrawn: \"Steam or heat leaks"));
  EXPECT_THAT(words, HasSubstr("What was named does not improve the prediction"));
  EXPECT_THAT(words, Not(HasSubstr("Missing from the model")));
  EXPECT_THAT(words, Not(HasSubstr("better than all others together")));
}

TEST_F(DiagnosisFiles, WordsNameTheMeasurementThatPartsConfusableEffects) {
  Diagnosis d = recald::testing::nothing_named(site_);
  d.outcome = diagnosis::Outcome::confusable;
  d.why = "several effects explain the gap equally well";
  d.passes[0].naming.confusable = {"steam_trap_leak", "seasonal_hot_water"};
  d.passes[0].naming.probabilities = {
      {"seasonal_hot_water", -1, 0.5, 1}, {"steam_trap_leak", -1, 0.45, 0}, {"none", -1, 0.05, {}}};
  const OutcomeWords words = outcome_words(d, site_);
  EXPECT_THAT(words.headline, StartsWith("Two explanations fit equally well: \"More hot water"));
  EXPECT_THAT(diagnosis_words(d, site_), HasSubstr("Close the hot-water loop's valve"));
  for (const Separation& s : separations_of(d, site_)) {
    EXPECT_THAT(s.rival, Not(HasSubstr("scale"))) << "not in the set";
  }
}

TEST_F(DiagnosisFiles, WordsOfNothingFoundAreHonest) {
  Diagnosis d = recald::testing::nothing_named(site_);
  EXPECT_EQ(outcome_words(d, site_).headline, "No missing effect was found.");
  d.passes[0].located.clear();
  EXPECT_EQ(outcome_words(d, site_).headline,
            "The calibrated model agrees with the meters within chance.");
}

TEST_F(DiagnosisFiles, NoPercentageOfNextToNothing) {
  Diagnosis d = recald::testing::nothing_named(site_);
  d.passes[0].located[0].share = 2.5e12;
  d.passes[0].located[0].share_se = 4e11;
  EXPECT_THAT(diagnosis_words(d, site_),
              HasSubstr("Steam, working days 00-04 h: the simulation has almost nothing there, "
                        "+2,100\u00a0kWh a month"));
}

TEST_F(DiagnosisFiles, MonthsWithoutReadingsTaughtNothing) {
  for (Eigen::Index i = 0; i < site_.day_parts.count(); ++i) {
    if (site_.day_parts.parts[static_cast<std::size_t>(i)].month == 2) {
      site_.measured_parts_kW.row(i) = std::nan("");
    }
  }
  const auto next = diagnosis::next_version(recald::testing::one_named(site_), site_, {}, {});
  EXPECT_EQ(next.effects[0].months_used.size(), 5u);
  EXPECT_THAT(next.effects[0].months_used, Not(::testing::Contains(site_.drivers->months[2])));
}

TEST_F(DiagnosisFiles, WithoutMonthsKeptBackNothingIsCalledConfirmed) {
  Diagnosis d = recald::testing::one_named(site_);
  d.gap.reset();
  site_.roles.assign(site_.roles.size(), diagnosis::Role::fit);
  EXPECT_THAT(diagnosis_words(d, site_), HasSubstr("nothing confirms this yet"));
  EXPECT_TRUE(json_of(d)["gap"].is_null());
  EXPECT_THAT(page_data(d).steps, IsEmpty());
}

TEST_F(DiagnosisFiles, ThePageHasBeforeAndAfterAndTheSteps) {
  const DiagnosisData data = page_data(recald::testing::one_named(site_));
  EXPECT_EQ(data.outcome, diagnosis::Outcome::named);
  EXPECT_THAT(data.meters, ElementsAre("Chilled water", "Steam"));
  ASSERT_TRUE(data.maps[1].after.has_value());
  EXPECT_NEAR(data.maps[1].before.by_month(0, 0), 0.10, 1e-12);
  EXPECT_NEAR(data.maps[1].after->by_month(0, 0), 0.04, 1e-12);
  ASSERT_EQ(data.steps.size(), 2u);
  EXPECT_EQ(data.steps[1].label, "+ Steam or heat leaks in the pipes");
  EXPECT_EQ(data.steps[1].gaps[1].cvrmse_daily, 0.08);
  ASSERT_EQ(data.signatures.size(), 2u);
  EXPECT_NEAR(data.signatures[1].residual.by_part_of_week[0], 0.10, 1e-12);
  EXPECT_NEAR(data.signatures[1].change.by_part_of_week[0], 0.06, 1e-12);
  EXPECT_NEAR(data.signatures[1].effect_alone.by_part_of_week[0], 0.04, 1e-12);
  EXPECT_THAT(render_diagnosis(data), HasSubstr("Probability 93"));
}

// A meter that was never read on the months kept back, and not at all in March.
TEST_F(DiagnosisFiles, ThePageSurvivesHolesInTheRecord) {
  for (Eigen::Index i = 0; i < site_.day_parts.count(); ++i) {
    const auto at = static_cast<std::size_t>(i);
    const bool hole =
        site_.roles[at] == diagnosis::Role::show || site_.day_parts.parts[at].month == 2;
    if (hole) site_.measured_parts_kW(i, 1) = std::nan("");
  }
  const DiagnosisData data = page_data(recald::testing::one_taken_back(site_));
  EXPECT_TRUE(data.not_confirmed);
  EXPECT_TRUE(data.maps[1].before.by_month.col(2).isNaN().all());
  EXPECT_TRUE(std::isnan(data.steps[0].gaps[1].cvrmse_daily));
  EXPECT_EQ(data.steps[0].gaps[0].cvrmse_daily, 0.14);
  EXPECT_THAT(render_diagnosis(data), HasSubstr("✕ Not confirmed"));
  EXPECT_THAT(render_diagnosis(page_data(recald::testing::nothing_named(site_))),
              HasSubstr("○ Nothing named"));
}

}  // namespace
}  // namespace recald::views
