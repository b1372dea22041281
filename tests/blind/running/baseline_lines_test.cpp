#include "tests/blind/running/baseline_lines.hpp"

#include <gtest/gtest.h>

#include "tests/blind/running/made_up_diagnosis.hpp"
#include "tests/blind/scoring/case_result.hpp"

namespace recald::blind {
namespace {

Json line_of(const Json& diagnosis, const char* baseline) {
  const auto line = baseline_line(diagnosis, {"sealed-017", baseline});
  EXPECT_TRUE(line.has_value()) << line.error().message;
  if (!line) return Json::object();
  const auto read = parse_case_result(line->dump(), baseline);
  EXPECT_TRUE(read.has_value()) << read.error().message;
  return *line;
}

/// Likelihood gains of the two scale faults, of one parameter each.
Json with_gains(double electricity, double heating) {
  Json diagnosis = made_up::diagnosis();
  diagnosis["candidates"][0]["log_likelihood_gain"] = electricity;
  diagnosis["candidates"][1]["log_likelihood_gain"] = heating;
  return diagnosis;
}

TEST(Baselines, RefittingAddsNothing) {
  Json line = line_of(made_up::diagnosis(), "refit_only");
  EXPECT_EQ(line["outcome"], "none");
  EXPECT_FALSE(line.contains("gap"));
}

TEST(Baselines, AicNamesWhatGainsMoreThanItsParameters) {
  Json line = line_of(with_gains(3.0, 2.0), "aic");
  EXPECT_EQ(line["named"], (Json{"scale_fault"}));
  // Akaike weights: e^(3 - 1) against 1.
  EXPECT_NEAR(line["probabilities"]["scale_fault"].get<double>(), 0.8807970779778823, 1e-12);
}

TEST(Baselines, AicNamesNothingThatGainsLess) {
  Json line = line_of(with_gains(0.9, 0.5), "aic");
  EXPECT_EQ(line["outcome"], "none");
  EXPECT_EQ(line["named"], Json::array());
}

TEST(Baselines, TheFirstLookNamesFromFiveOn) {
  Json diagnosis = made_up::diagnosis();
  diagnosis["first_look"] = {{{"effect", "phase_lost"}, {"log_bayes_factor", 4.9}},
                             {{"effect", "scale_fault"}, {"log_bayes_factor", -1.0}},
                             {{"effect", "phase_lost"}, {"log_bayes_factor", 2.0}}};
  Json below = line_of(diagnosis, "first_look");
  EXPECT_EQ(below["outcome"], "none");
  // Two names share the prior of one half: e^4.9 / 4 against 1 / 2 and e^-1 / 4.
  EXPECT_NEAR(below["probabilities"]["phase_lost"].get<double>(), 0.9826729109, 1e-9);
  diagnosis["first_look"][2]["log_bayes_factor"] = 5.1;
  EXPECT_EQ(line_of(diagnosis, "first_look")["named"], (Json{"phase_lost"}));
}

TEST(Baselines, TheUnknownModelAloneNamesNothing) {
  Json diagnosis = made_up::diagnosis();
  EXPECT_EQ(line_of(diagnosis, "unknown_only")["outcome"], "none");
  diagnosis["unknown_gain"] = 5.1;
  Json line = line_of(diagnosis, "unknown_only");
  EXPECT_EQ(line["outcome"], "unknown");
  // 0.1 e^5.1 against 0.5.
  EXPECT_NEAR(line["probabilities"]["unknown"].get<double>(), 0.9704180359, 1e-9);
}

TEST(Baselines, WithoutTheirKeyThereIsNoLine) {
  for (const char* baseline : {"aic", "first_look"}) {
    const auto line = baseline_line(made_up::diagnosis(), {"sealed-017", baseline});
    ASSERT_FALSE(line.has_value()) << baseline;
    EXPECT_EQ(line.error().code, ErrorCode::not_found);
  }
}

TEST(Baselines, AWrongValueIsAMistake) {
  Json diagnosis = made_up::diagnosis();
  diagnosis["unknown_gain"] = nullptr;
  const auto line = baseline_line(diagnosis, {"sealed-017", "unknown_only"});
  ASSERT_FALSE(line.has_value());
  EXPECT_EQ(line.error().code, ErrorCode::malformed);
}

}  // namespace
}  // namespace recald::blind
