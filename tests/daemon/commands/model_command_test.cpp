#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "adapters/models/model_store.hpp"
#include "daemon/site/model/active_effects.hpp"
#include "tests/adapters/models/sample_version.hpp"
#include "tests/daemon/command_line.hpp"
#include "tests/support/sample_site.hpp"
#include "tests/support/temporary_folder.hpp"

namespace recald::daemon {
namespace {

using diagnosis::short_version;
using recald::testing::heat_meter_scale;
using recald::testing::kSampleMeters;
using recald::testing::night_setback;
using recald::testing::sample_version;
using recald::testing::write_text;
using std::chrono::year;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using testing::Outcome;
using testing::run;
using ::testing::StartsWith;

class ModelCommand : public ::testing::Test {
 protected:
  ModelCommand() { write_text(folder_ / "site.toml", kSampleMeters); }

  /// Adds both effects, one version each; the second is in force.
  void add_two() {
    const models::ModelStore store{folder_ / "site.toml", "depot"};
    first_ = store.save(sample_version("drawings", {night_setback()}))->version;
    second_ = store
                  .save(sample_version(first_, {night_setback(), heat_meter_scale()},
                                       "2021-03-02T05:00:00Z"))
                  ->version;
    ASSERT_TRUE(store.activate(first_, "2021-04-01T00:00:00Z").has_value());
    ASSERT_TRUE(store.activate(second_, "2021-05-01T00:00:00Z").has_value());
  }
  [[nodiscard]] std::string site() const { return (folder_ / "site.toml").string(); }

  recald::testing::TemporaryFolder folder_;
  std::string first_;
  std::string second_;
};

TEST_F(ModelCommand, WrongUsageIsTwo) {
  const std::vector<std::vector<std::string>> misuses = {
      {"model"}, {"model", "list"}, {"model", "forget", site()}, {"model", "list", site(), "more"}};
  for (const auto& arguments : misuses) {
    EXPECT_EQ(run(arguments).exit_code, kUsage) << ::testing::PrintToString(arguments);
  }
  EXPECT_EQ(run({"model", "--help"}).exit_code, kSuccess);
  EXPECT_THAT(run({"model", "--help"}).out, HasSubstr("revert"));
}

TEST_F(ModelCommand, SiteFileThatIsAbsentIsOneSentence) {
  for (const char* verb : {"list", "show", "revert"}) {
    const Outcome outcome = run({"model", verb, site() + "x"});
    EXPECT_EQ(outcome.exit_code, kFailure);
    EXPECT_EQ(outcome.err, "recald: site file '" + site() + "x' does not exist\n");
  }
}

TEST_F(ModelCommand, SiteWithoutAdditionsHasItsDrawings) {
  EXPECT_THAT(run({"model", "list", site()}).out, StartsWith("* drawings      accepted"));
  EXPECT_EQ(run({"model", "show", site()}).out,
            "drawings: the model as described in the site file, without effects\n");
  const Outcome reverted = run({"model", "revert", site()});
  EXPECT_EQ(reverted.exit_code, kFailure);
  EXPECT_EQ(reverted.err,
            "recald: the model is as the drawings have it already; there is nothing to revert\n");
}

TEST_F(ModelCommand, ListMarksTheOneInForce) {
  add_two();
  const Outcome outcome = run({"model", "list", site()});
  EXPECT_EQ(outcome.exit_code, kSuccess);
  EXPECT_EQ(outcome.out,
            "  drawings      accepted                        no effects\n"
            "  " +
                short_version(first_) +
                "  accepted  2021-03-01T05:00:00Z  night_setback_missing\n"
                "* " +
                short_version(second_) +
                "  accepted  2021-03-02T05:00:00Z  night_setback_missing, meter_scale "
                "(district_heat)\n");
  const auto json = nlohmann::json::parse(run({"model", "list", site(), "--json"}).out);
  EXPECT_EQ(json["active"], second_);
  ASSERT_EQ(json["versions"].size(), 3u);
  EXPECT_EQ(json["versions"][2]["parent"], first_);
  EXPECT_EQ(json["versions"][2]["active"], true);
  EXPECT_EQ(json["versions"][1]["active"], false);
  EXPECT_THAT(json["damaged"], IsEmpty());
}

TEST_F(ModelCommand, ShowSaysWhatAnEffectWasAcceptedOn) {
  add_two();
  const Outcome outcome = run({"model", "show", site(), short_version(first_)});
  EXPECT_EQ(outcome.exit_code, kSuccess);
  EXPECT_EQ(
      outcome.out,
      short_version(first_) +
          ", accepted (auto), made 2021-03-01T05:00:00Z\nparent drawings, data 0123456789ab, "
          "catalogue 0.1.0\n\nNight set-back missing (night_setback_missing)\n  theta_set,unocc = "
          "theta_set,occ - (1 - f) dT  [K]\n  probability 93.0\u00a0%, evidence gain 14.3 nats\n  "
          "rival: damper_stuck_open 5 %\n  rival: none 2 %\n  share [-]: 0.8 ± 0.1, 90 % 0.65 to "
          "0.95; prior uniform 0.5 ± 0.29\n  slope [K/h]: 2.1 ± 0.4, 90 % 1.5 to 2.9; prior "
          "log_normal 2.266 ± 1.2\n  Electricity: +310 kWh a month\n  District heat: +5200 kWh a "
          "month\n  learned from 3 months, 2020-11 to 2021-01\n");
  const Outcome active = run({"model", "show", site()});
  EXPECT_THAT(active.out, HasSubstr("Meter's factor wrong (meter_scale), meter district_heat from "
                                    "2020-12-05 until 2021-01-20\n"));
  const auto json = nlohmann::json::parse(run({"model", "show", site(), "--json"}).out);
  EXPECT_EQ(json["version"], second_);
  EXPECT_EQ(json["effects"][0]["parameters"][0]["draws"][1], 1.0 / 3.0);
}

TEST_F(ModelCommand, RevertGoesBackStepByStepOrToAVersion) {
  add_two();
  const Outcome outcome = run({"model", "revert", site()});
  EXPECT_EQ(outcome.exit_code, kSuccess) << outcome.err;
  EXPECT_EQ(outcome.out, "The model is back at version " + short_version(first_) +
                             ", with night_setback_missing.\n");
  const auto json =
      nlohmann::json::parse(run({"model", "revert", site(), "drawings", "--json"}).out);
  EXPECT_EQ(json["active"], "drawings");
  EXPECT_THAT(json["effects"], IsEmpty());
  EXPECT_THAT(run({"model", "list", site()}).out, HasSubstr(short_version(first_) + "  reverted"));
}

TEST_F(ModelCommand, ApplyPutsAVersionInForce) {
  add_two();
  ASSERT_EQ(run({"model", "revert", site(), "drawings"}).exit_code, kSuccess);
  const Outcome outcome = run({"model", "apply", site(), short_version(first_)});
  EXPECT_EQ(outcome.exit_code, kSuccess) << outcome.err;
  EXPECT_EQ(outcome.out, "The model is now at version " + short_version(first_) +
                             ", with night_setback_missing.\n");
  EXPECT_EQ(run({"model", "apply", site(), short_version(first_)}).exit_code, kFailure);
  EXPECT_EQ(run({"model", "apply", site()}).exit_code, kUsage);
}

TEST_F(ModelCommand, UnknownVersionIsOneSentence) {
  add_two();
  for (const char* verb : {"show", "revert"}) {
    const Outcome outcome = run({"model", verb, site(), "0000"});
    EXPECT_EQ(outcome.exit_code, kFailure);
    EXPECT_THAT(outcome.err,
                StartsWith("recald: the model of site 'depot' has no version '0000'; it has "
                           "drawings, "));
  }
}

TEST_F(ModelCommand, DamagedFileIsNamedAndTheOthersListed) {
  add_two();
  write_text(folder_ / ("site.models/" + second_ + ".json"), "{}");
  const Outcome outcome = run({"model", "list", site()});
  EXPECT_EQ(outcome.exit_code, kSuccess);
  EXPECT_THAT(outcome.err, HasSubstr(second_ + ".json' is damaged: its content does not match"));
  EXPECT_THAT(outcome.out, HasSubstr(short_version(first_)));
  EXPECT_EQ(run({"model", "show", site()}).exit_code, kFailure);
}

TEST_F(ModelCommand, CalibrationMeetsTheEffectsInForceOrTheirDamage) {
  const auto config = load_site(folder_ / "site.toml");
  EXPECT_THAT(*active_effects(*config), IsEmpty());
  add_two();
  EXPECT_EQ(*active_effects(*config), (std::vector{night_setback(), heat_meter_scale()}));
  write_text(folder_ / ("site.models/" + second_ + ".json"), "{");
  EXPECT_FALSE(active_effects(*config).has_value());
}

TEST(ActiveEffects, OnlyMonthsAfterTheDiagnosisTeach) {
  EXPECT_FALSE(may_learn_from(night_setback(), year{2020} / 1));  // before its data: still the cut
  EXPECT_FALSE(may_learn_from(night_setback(), year{2021} / 1));
  EXPECT_TRUE(may_learn_from(night_setback(), year{2021} / 2));
}

TEST(ActiveEffects, MetaModelRefusesAnEffectThatItsDesignDidNotVary) {
  const std::vector<diagnosis::AddedEffect> effects{night_setback(), heat_meter_scale()};
  std::vector<Parameter> design;
  for (const char* name : {"occupancy_density", "night_setback_missing_share",
                           "night_setback_missing_slope", "meter_scale_district_heat_factor"}) {
    design.push_back({name, "-", UniformPrior{0.0, 1.0}});
  }
  const auto refused = require_in_design(effects, design);
  ASSERT_FALSE(refused.has_value());
  EXPECT_EQ(refused.error().code, ErrorCode::unsupported);
  EXPECT_EQ(refused.error().message,
            "metamodel: effect meter_scale is not in the design; run `recald doe` with it.");
  design.push_back({"meter_scale_district_heat_day", "-", UniformPrior{0.0, 1.0}});
  EXPECT_TRUE(require_in_design(effects, design).has_value());
  EXPECT_TRUE(require_in_design({}, {}).has_value());
}

}  // namespace
}  // namespace recald::daemon
