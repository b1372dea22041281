#include "core/diagnosis/usual_errors.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/diagnosis/candidate_shapes.hpp"

namespace recald::diagnosis {
namespace {

/// Of an effect with many shapes a few stand for all.
constexpr std::size_t kShapesMax = 3;

struct UsualAmount {
  std::string_view effect;
  double sd;
};

constexpr double kAnyEffect = 0.3;
constexpr auto kUsualAmounts = std::to_array<UsualAmount>({
    {"after_hours", 0.10},
    {"chiller_part_load", 0.72},
    {"clock_offset", 0.65},
    {"constant_flow_pumps", 0.33},
    {"constant_speed_fans", 0.37},
    {"damper_stuck_open", 0.83},
    {"deep_drying", 0.23},
    {"demand_limit", 0.07},
    {"demand_ventilation", 0.38},
    {"dst_misapplied", 0.09},
    {"early_start", 0.33},
    {"economiser_changeover", 0.13},
    {"economiser_failed", 0.19},
    {"exterior_lighting", 0.78},
    {"fouling", 0.44},
    {"ground_coupling", 0.61},
    {"humidifier", 0.10},
    {"hybrid_work", 0.26},
    {"missing_holidays", 0.06},
    {"night_setback_missing", 0.19},
    {"outdoor_air_amount", 0.35},
    {"plug_growth", 0.10},
    {"round_the_clock_zone", 0.26},
    {"scale_fault", 1.86},
    {"seasonal_hot_water", 0.37},
    {"semester_calendar", 0.07},
    {"server_room", 1.24},
    {"simultaneous_heating_cooling", 2.40},
    {"solar_gain_change", 0.59},
    {"stack_infiltration", 0.64},
    {"steam_trap_leak", 1.36},
    {"supply_reset_missing", 0.37},
    {"thermal_mass", 1.62},
    {"weekend_operation", 0.07},
    {"wind_infiltration", 0.15},
});

/// The first, the last and one in the middle.
std::vector<std::vector<double>> few_shapes(const Candidate& candidate) {
  std::vector<std::vector<double>> shapes = own_shapes(candidate);
  if (shapes.size() <= kShapesMax) return shapes;
  return {shapes.front(), shapes[shapes.size() / 2], shapes.back()};
}

}  // namespace

UsualErrors UsualErrors::draw(Predictor& predictor, const SiteProblem& site,
                              std::span<const double> theta) {
  UsualErrors errors;
  errors.base_kW_ = predictor.parts_kW(theta);
  const SiteFacts facts = site.facts();
  for (const Candidate& candidate : list_candidates(site).candidates) {
    if (candidate.begins) continue;
    const auto shapes = few_shapes(candidate);
    const double sd = usual_amount_sd(candidate.effect->id) / std::sqrt(double(shapes.size()));
    for (const std::vector<double>& shape : shapes) {
      const auto alteration = alteration_of(candidate, facts, shape);
      errors.footprints_kW_.emplace_back(
          sd * (predictor.parts_kW(theta, alteration.get()) - errors.base_kW_));
      errors.effects_.push_back(candidate.effect->id);
    }
  }
  return errors;
}

Eigen::MatrixXd UsualErrors::columns(const Observations& observations) const {
  Eigen::MatrixXd columns(observations.count(), count());
  if (count() == 0) return columns;
  const Eigen::VectorXd base = observations.stack(base_kW_);
  for (Eigen::Index k = 0; k < count(); ++k) {
    columns.col(k) =
        observations.stack(base_kW_ + footprints_kW_[static_cast<std::size_t>(k)]) - base;
  }
  return columns;
}

double usual_amount_sd(std::string_view effect) {
  const auto found = std::ranges::find(kUsualAmounts, effect, &UsualAmount::effect);
  return found == kUsualAmounts.end() ? kAnyEffect : found->sd;
}

}  // namespace recald::diagnosis
