#include "daemon/site/model/diagnosis_input.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <optional>
#include <sstream>

#include "daemon/commands/open_site.hpp"
#include "tests/daemon/depot_year.hpp"

namespace recald::daemon {
namespace {

using diagnosis::SiteProblem;

class SiteProblemTest : public ::testing::Test {
 protected:
  SiteProblemTest() {
    recald::testing::write_depot_year(folder_.path());
    std::ostringstream ignored;
    auto opened = open_modelled_site(folder_ / "site.toml", Console{ignored, ignored, false},
                                     ModelKind::hourly);
    if (!opened) throw std::runtime_error(ignored.str());
    modelled_ = std::make_unique<ModelledSite>(std::move(*opened));
  }

  [[nodiscard]] SiteProblem problem() const {
    auto made = make_site_problem(modelled_->site.config, modelled_->site.calendar,
                                  modelled_->recording, modelled_->weather);
    if (!made) throw std::runtime_error(made.error().message);
    return std::move(*made);
  }

  /// Its place among the parameters.
  static std::optional<Eigen::Index> index_of(const SiteProblem& problem, std::string_view name) {
    const auto found = std::ranges::find(problem.parameters, name, &Parameter::name);
    if (found == problem.parameters.end()) return std::nullopt;
    return found - problem.parameters.begin();
  }

  recald::testing::TemporaryFolder folder_;
  std::unique_ptr<ModelledSite> modelled_;
};

TEST_F(SiteProblemTest, WhatNoDrawingGivesBeginsWhereBuildingsUsuallyAre) {
  const SiteProblem depot = problem();
  const auto start_of = [&](std::string_view name) {
    return depot.parameters[static_cast<std::size_t>(index_of(depot, name).value())]
        .prior.at_score(0.0)
        .value;
  };
  EXPECT_NEAR(start_of("mass_coupling"), 0.5, 1e-9);
  EXPECT_NEAR(start_of("core_mass"), 0.3, 1e-9);
  EXPECT_NEAR(start_of("air_capacity"), 35.0, 1e-9);
}

TEST_F(SiteProblemTest, OnlyAnOwnChillerHasALiftAndIdles) {
  EXPECT_FALSE(index_of(problem(), "chiller_lift"));
  EXPECT_FALSE(index_of(problem(), "cooling_idle"));
  modelled_->site.config.building->chiller_cop = 3.0;
  const SiteProblem site = problem();
  EXPECT_TRUE(index_of(site, "chiller_lift"));
  const auto idle = index_of(site, "cooling_idle");
  ASSERT_TRUE(idle);
  // W/m2, where no drawing tells of pumps.
  EXPECT_NEAR(site.parameters[*idle].prior.at_score(0.0).value, 1.5, 1e-9);
  EXPECT_TRUE(index_of(site, "electric_use"));
  model::Building& building = *modelled_->site.config.building;
  building.cooling_idle_kW = 1e-3 * 0.4 * building.floor_area_m2;
  EXPECT_NEAR(problem().parameters[*idle].prior.at_score(0.0).value, 0.4, 1e-9);
}

}  // namespace
}  // namespace recald::daemon
