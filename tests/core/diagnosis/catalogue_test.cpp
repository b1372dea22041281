#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <set>

#include "core/diagnosis/effects/support/effect.hpp"
#include "core/model/hourly/hourly.hpp"
#include "tests/support/sample_building.hpp"

namespace recald::diagnosis::catalogue_test {
namespace {

using metering::Utility;
using model::hourly::Alteration;
using model::hourly::StepOperation;

/// A year of a building that has all an entry may ask for, with its three meters.
class Catalogue : public ::testing::Test {
 protected:
  static model::Building equipped_building() {
    model::Building building = testing::sample_building();
    building.air->economiser_lockout_C = 18.0;
    building.air->humidification_kg_kg = 0.005;
    building.chiller_cop = 4.0;
    building.hot_water.mains_amplitude_K = 4.0;
    return building;
  }

  Eigen::ArrayXXd run(const Alteration* alteration) {
    Eigen::ArrayXXd power_kW(hourly_.step_count(), static_cast<Eigen::Index>(meters_.size()));
    const std::array<const Alteration*, 1> one{alteration};
    hourly_.run(building_, alteration ? std::span{one} : std::span<const Alteration* const>{},
                meters_, power_kW);
    return power_kW;
  }

  static int meter_of(const Effect& effect) { return effect.of_one_meter ? 0 : -1; }

  model::Building building_ = equipped_building();
  std::shared_ptr<const model::Drivers> drivers_ =
      std::make_shared<model::Drivers>(testing::sample_drivers(building_, 12));
  std::vector<model::MeterMap> meters_ = {*model::default_meter_map(Utility::electricity),
                                          *model::default_meter_map(Utility::chilled_water),
                                          *model::default_meter_map(Utility::steam)};
  SiteFacts facts_{.building = building_,
                   .drivers = *drivers_,
                   .utilities = {Utility::electricity, Utility::chilled_water, Utility::steam},
                   .mean_kW = {120.0, 90.0, 80.0}};
  model::hourly::Hourly hourly_{drivers_};
};

bool is_shape(const EffectParameter& parameter) { return std::isnan(parameter.neutral); }

double usual_value(const EffectParameter& parameter) {
  if (!parameter.scan.empty()) return parameter.scan[parameter.scan.size() / 2];
  const double mean = parameter.prior.mean();
  const double away = std::sqrt(parameter.prior.variance());
  return std::abs(mean - parameter.neutral) < 0.5 * away ? mean + away : mean;
}

TEST_F(Catalogue, IsSortedAndNamesAreThoseOfItsFiles) {
  std::set<std::string> files;
  for (const auto& file : std::filesystem::directory_iterator(
           std::filesystem::path{RECALD_SOURCE_DIR} / "core/diagnosis/effects")) {
    if (file.path().extension() == ".cpp") files.insert(file.path().stem().string());
  }
  std::vector<std::string> ids;
  for (const Effect& effect : catalogue()) ids.emplace_back(effect.id);
  EXPECT_EQ(ids, std::vector<std::string>(files.begin(), files.end()));
}

TEST_F(Catalogue, FindsEveryEntryAndNoOther) {
  for (const Effect& effect : catalogue()) EXPECT_EQ(find_effect(effect.id), &effect);
  EXPECT_EQ(find_effect("a_ghost"), nullptr);
  EXPECT_EQ(find_effect("zz"), nullptr);
}

TEST_F(Catalogue, SaysWhatEachEntryIsAndWhatPartsItFromItsRivals) {
  for (const Effect& effect : catalogue()) {
    SCOPED_TRACE(effect.id);
    EXPECT_GT(effect.title.size(), 5u);
    EXPECT_LT(effect.title.size(), 50u);
    EXPECT_GT(effect.meaning.size(), 40u);
    EXPECT_EQ(effect.meaning.back(), '.');
    EXPECT_GT(effect.physics.size(), 10u);
    EXPECT_FALSE(effect.confusable.empty());
    for (const Confusable& rival : effect.confusable) {
      EXPECT_NE(find_effect(rival.effect), nullptr) << rival.effect;
      EXPECT_NE(rival.effect, effect.id);
      EXPECT_GT(rival.separated_by.size(), 15u);
    }
  }
}

TEST_F(Catalogue, HasPriorsThatHoldTheirNeutralAndScannedValues) {
  for (const Effect& effect : catalogue()) {
    SCOPED_TRACE(effect.id);
    const std::vector<EffectParameter> parameters = effect.parameters(facts_);
    ASSERT_FALSE(parameters.empty());
    EXPECT_LE(parameters.size(), 3u);
    std::set<std::string> names;
    for (const EffectParameter& parameter : parameters) {
      SCOPED_TRACE(parameter.name);
      EXPECT_TRUE(names.insert(parameter.name).second);
      EXPECT_FALSE(parameter.unit.empty());
      EXPECT_TRUE(Prior::make(parameter.prior.distribution()).has_value());
      EXPECT_GT(parameter.prior.variance(), 0.0);
      if (!is_shape(parameter)) {
        EXPECT_GE(parameter.neutral, parameter.prior.min());
        EXPECT_LE(parameter.neutral, parameter.prior.max());
      }
      for (const double value : parameter.scan) {
        EXPECT_GE(value, parameter.prior.min());
        EXPECT_LE(value, parameter.prior.max());
      }
    }
  }
}

// A site without meters of a kind, or with dead ones, must not give a prior of no width.
TEST_F(Catalogue, HasProperPriorsWhereMetersAreMissing) {
  SiteFacts bare{.building = building_, .drivers = *drivers_, .utilities = {}, .mean_kW = {}};
  for (const Effect& effect : catalogue()) {
    SCOPED_TRACE(effect.id);
    for (const EffectParameter& parameter : effect.parameters(bare)) {
      EXPECT_TRUE(Prior::make(parameter.prior.distribution()).has_value()) << parameter.name;
    }
  }
}

TEST_F(Catalogue, ChangesNoBitAtNeutralValues) {
  const Eigen::ArrayXXd base_kW = run(nullptr);
  for (const Effect& effect : catalogue()) {
    SCOPED_TRACE(effect.id);
    std::vector<double> values;
    for (const EffectParameter& parameter : effect.parameters(facts_)) {
      values.push_back(is_shape(parameter) ? usual_value(parameter) : parameter.neutral);
    }
    const auto alteration = effect.bind(facts_, values, meter_of(effect));
    EXPECT_TRUE((run(alteration.get()) == base_kW).all());
  }
}

TEST_F(Catalogue, ChangesSomethingAtUsualValues) {
  const Eigen::ArrayXXd base_kW = run(nullptr);
  for (const Effect& effect : catalogue()) {
    SCOPED_TRACE(effect.id);
    std::vector<double> values;
    for (const EffectParameter& parameter : effect.parameters(facts_)) {
      values.push_back(usual_value(parameter));
    }
    const auto alteration = effect.bind(facts_, values, meter_of(effect));
    const Eigen::ArrayXXd power_kW = run(alteration.get());
    EXPECT_TRUE(power_kW.isFinite().all());
    EXPECT_GT((power_kW - base_kW).abs().maxCoeff(), 0.01);
  }
}

TEST_F(Catalogue, TouchesOnlyTheMeterThatAFaultIsBoundTo) {
  const Eigen::ArrayXXd base_kW = run(nullptr);
  for (const Effect& effect : catalogue()) {
    if (!effect.of_one_meter) continue;
    SCOPED_TRACE(effect.id);
    std::vector<double> values;
    for (const EffectParameter& parameter : effect.parameters(facts_)) {
      values.push_back(usual_value(parameter));
    }
    const Eigen::ArrayXXd power_kW = run(effect.bind(facts_, values, 1).get());
    EXPECT_TRUE((power_kW.col(0) == base_kW.col(0)).all());
    EXPECT_FALSE((power_kW.col(1) == base_kW.col(1)).all());
    EXPECT_TRUE((power_kW.col(2) == base_kW.col(2)).all());
  }
}

/// Marks each hour and each recorded value it is shown.
class Marker final : public Alteration {
 public:
  void operate(const model::DriverHour&, StepOperation& operation) const override {
    operation.exterior_W += 1.0;
  }
  void supply(const model::Building&, const model::DriverHour&, const StepOperation&,
              model::hourly::StepLoads& loads) const override {
    loads.pumps_W += 1.0;
  }
  void record(std::span<const model::DriverHour> hours, int,
              std::span<double> power_kW) const override {
    EXPECT_EQ(power_kW.size(), 4 * hours.size());
    for (double& value : power_kW) value += 1.0;
  }
};

TEST_F(Catalogue, LimitsAnEffectToItsDates) {
  // 06:00 of the second day up to 18:00 of the third: 36 hours.
  const auto dated = within_dates(std::make_unique<Marker>(), 1.25, 2.75);
  const std::span hours = std::span{drivers_->hours}.first(24 * 5);
  double operated = 0.0;
  double supplied = 0.0;
  for (const model::DriverHour& hour : hours) {
    StepOperation operation{};
    model::hourly::StepLoads loads{};
    dated->operate(hour, operation);
    dated->supply(building_, hour, operation, loads);
    operated += operation.exterior_W;
    supplied += loads.pumps_W;
  }
  EXPECT_EQ(operated, 36.0);
  EXPECT_EQ(supplied, 36.0);

  std::vector<double> power_kW(4 * hours.size(), 0.0);
  dated->record(hours, 0, power_kW);
  for (std::size_t i = 0; i < power_kW.size(); ++i) {
    EXPECT_EQ(power_kW[i], i >= 4 * 30 && i < 4 * 66 ? 1.0 : 0.0) << i;
  }
}

TEST_F(Catalogue, DoesNothingBetweenDatesInWrongOrder) {
  const auto dated = within_dates(std::make_unique<Marker>(), 9.0, 3.0);
  std::vector<double> power_kW(4 * drivers_->hours.size(), 0.0);
  dated->record(drivers_->hours, 0, power_kW);
  EXPECT_EQ(std::ranges::count(power_kW, 0.0), std::ssize(power_kW));
}

TEST_F(Catalogue, CountsSteamAndGasAsHeat) {
  EXPECT_EQ(facts_.mean_of_kW(Utility::heating), 80.0);
  EXPECT_EQ(facts_.mean_of_kW(Utility::chilled_water), 90.0);
  EXPECT_EQ(facts_.mean_of_kW(Utility::water), 0.0);
}

TEST_F(Catalogue, NamesItsClasses) {
  std::set<std::string_view> names;
  for (const Effect& effect : catalogue()) names.insert(to_string(effect.effect_class));
  EXPECT_EQ(names.size(), 7u);
  EXPECT_TRUE(names.contains("outdoor_air"));
}

}  // namespace
}  // namespace recald::diagnosis::catalogue_test
