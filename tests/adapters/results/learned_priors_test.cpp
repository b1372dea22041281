#include "adapters/results/learned_priors.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

namespace recald::results {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;

/// A site whose outdoor air is well known, at `share` of the drawings' `design`.
json document(double share, double design) {
  const Prior prior{0.3 * design, design, 1.2 * design};
  const Prior people{0.0, 0.05, 0.1};
  const auto entry = [](const char* name, const char* unit, double q05, double q50, double q95,
                        const Prior& of) {
    return json{{"name", name},
                {"unit", unit},
                {"q05", q05},
                {"q50", q50},
                {"q95", q95},
                {"prior",
                 {{"distribution", "triangular"},
                  {"min", of.min()},
                  {"mode", of.mode()},
                  {"max", of.max()}}}};
  };
  return {{"model", "epc"},
          {"status", "converged"},
          {"parameters",
           {entry("outdoor_airflow", "m3/s", (share - 0.08) * design, share * design,
                  (share + 0.08) * design, prior),
            entry("occupancy_density", "person/m2", people.quantile(0.05), people.quantile(0.5),
                  people.quantile(0.95), people)}}};
}

std::vector<json> portfolio() {
  std::vector<json> documents;
  for (int i = 0; i < 8; ++i) documents.push_back(document(0.5 + 0.02 * i, 1.0 + i));
  return documents;
}

const std::vector<Parameter> kBuilding = {{"outdoor_airflow", "m3/s", {6.0, 20.0, 24.0}},
                                          {"occupancy_density", "person/m2", {0.0, 0.1, 0.2}}};

TEST(LearnedPriors, AreOfTheBuildingsOwnSize) {
  const auto priors = learned_priors(portfolio(), kBuilding, "epc");
  ASSERT_EQ(priors.size(), 2U);
  ASSERT_TRUE(priors[0].learned);
  EXPECT_EQ(priors[0].sites, 8);
  EXPECT_EQ(priors[0].informative, 8);
  EXPECT_NEAR(priors[0].learned->quantile(0.5), 20.0 * 0.57, 0.8);
  EXPECT_LT(priors[0].learned->variance(), 0.5 * priors[0].own.variance());
  EXPECT_THAT(priors[0].sentence, HasSubstr("(90 %), from 8 of 8 sites."));
  EXPECT_THAT(priors[0].sentence, HasSubstr("instead of 9.55 to 22.1 m3/s"));  // F = 5 and 95 %
}

TEST(LearnedPriors, SayWhyNothingIsLearned) {
  const auto priors = learned_priors(portfolio(), kBuilding, "epc");
  EXPECT_FALSE(priors[1].learned);
  EXPECT_EQ(priors[1].sites, 8);
  EXPECT_EQ(priors[1].informative, 0);
  EXPECT_EQ(
      priors[1].sentence,
      "Occupancy density: no prior is learned; 0 of 8 calibrations say something of it beyond "
      "their priors, and at least 5 are needed.");
}

TEST(LearnedPriors, LeaveOutWhatCannotBePooled) {
  std::vector<json> documents = portfolio();
  documents[0]["model"] = "hourly";
  documents[1]["status"] = "unconverged";
  documents[2]["parameters"][0]["prior"]["source"] = "portfolio of 8 sites, 2026-11";
  documents[3]["parameters"][0]["prior"]["distribution"] = "log_normal";
  documents.push_back(
      json{{"status", "forecast"}, {"model", "change_point"}, {"parameters", json::array()}});
  EXPECT_EQ(learned_priors(documents, kBuilding, "epc")[0].sites, 4);
  EXPECT_FALSE(learned_priors(documents, kBuilding, "epc")[0].learned);
}

TEST(LearnedPriors, OfDocumentsOfOtherShapesAreNone) {
  std::vector<json> documents = portfolio();
  documents[0] = json::array({1, 2});
  documents[1]["parameters"] = "none";
  documents[2]["parameters"][0] = 7;
  documents[3]["parameters"][0]["prior"] = nullptr;
  documents[4]["parameters"][0]["q50"] = "a half";
  documents[5]["parameters"][0]["prior"]["max"] = 0.0;
  EXPECT_EQ(learned_priors(documents, kBuilding, "epc")[0].sites, 2);
}

TEST(LearnedPriors, AreLinesOfASiteFile) {
  const auto priors = learned_priors(portfolio(), kBuilding, "epc");
  const std::string lines = site_file_lines(priors, "2026-11");
  EXPECT_THAT(lines, HasSubstr("[[model.parameter]]\nname = \"outdoor_airflow\"\nprior = ["));
  EXPECT_THAT(lines, HasSubstr("source = \"portfolio of 8 sites, 2026-11\"\n\n"));
  EXPECT_THAT(lines, HasSubstr("[[model.parameter]]\nname = \"occupancy_density\"\n"));
  EXPECT_EQ(lines.find("prior = "), lines.rfind("prior = "));
}

TEST(LearnedPriors, AreAskedForWithTheParametersOfADocument) {
  const auto parameters = parameters_of(document(0.5, 20.0));
  ASSERT_EQ(parameters.size(), 2U);
  EXPECT_EQ(parameters[0].name, "outdoor_airflow");
  EXPECT_EQ(parameters[0].unit, "m3/s");
  EXPECT_EQ(parameters[0].prior, (Prior{6.0, 20.0, 24.0}));
  EXPECT_TRUE(parameters_of(json("text")).empty());
}

}  // namespace
}  // namespace recald::results
