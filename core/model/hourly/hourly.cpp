#include "core/model/hourly/hourly.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

#include "core/model/dark_hours.hpp"
#include "core/model/hourly/air_handlers.hpp"
#include "core/weather/psychrometrics.hpp"

namespace recald::model::hourly {
namespace {

constexpr std::size_t kWarmUp_h = 14 * 24;
constexpr double kCoilRelativeHumidity = 0.95;  // of air that leaves a wet coil
// The reset of supply air begins at this outdoor temperature and is complete this far below it.
constexpr double kResetFrom_C = 18.0;
constexpr double kResetOver_K = 13.0;
constexpr double kLeastLift_K = 1.0;  // between supply air and a closet
// Wet bulb at which chillers meet their nameplates (median of the training buildings), and the
// least share of their electricity in cold weather.
constexpr double kRatedWetBulb_C = 22.0;
constexpr double kLeastChillerCost = 0.4;

/// Set-points of rooms of which this share is at daytime values.
double between(double share, double daytime, double night) {
  return share * daytime + (1.0 - share) * night;
}

/// Share of an hour that lies within `reach_h` of a change, which is `distance_h` from its middle.
double covered(double reach_h, double distance_h) {
  return std::clamp(reach_h - (distance_h - 0.5), 0.0, 1.0);
}

/// Electricity per cooling of the building's own chiller, relative to the nameplate:
/// rises with the lift from chilled water to wet bulb.
double chiller_cost(const Building& building, double wet_bulb_C) {
  if (!building.chiller_cop) return 1.0;
  const double lift_K =
      (wet_bulb_C - kRatedWetBulb_C) - (building.chilled_water_C - kRatedChilledWater_C);
  return std::max(1.0 + building.chiller_lift_per_K * lift_K, kLeastChillerCost);
}

double weekly_mean(const HourlySchedule& schedule) {
  constexpr std::array<double, kDayTypes> kDaysPerWeek{5.0, 1.0, 1.0};
  double sum = 0.0;
  for (std::size_t day = 0; day < kDayTypes; ++day) {
    for (int hour = 0; hour < 24; ++hour) {
      sum += kDaysPerWeek[day] * schedule.at(static_cast<DayType>(day), hour);
    }
  }
  return sum / (7.0 * 24.0);
}

/// Share of the running part of an hour that lies in the first `closed_h` hours; its middle is
/// `since_start_h` after the start.
double closed_share(double closed_h, double since_start_h) {
  const double from_h = std::max(since_start_h - 0.5, 0.0);
  const double running_h = since_start_h + 0.5 - from_h;
  return running_h > 0.0 ? std::clamp((closed_h - from_h) / running_h, 0.0, 1.0) : 0.0;
}

}  // namespace

Hourly::Hourly(std::shared_ptr<const Drivers> drivers, const HourlyOptions& options)
    : drivers_(std::move(drivers)),
      options_(options),
      heat_capacity_J_m3K_(weather::air_heat_capacity_J_m3K(drivers_->pressure_Pa)) {
  assert(options.steps_per_hour == 1 || options.steps_per_hour == 4);
  const auto sides = drivers_->irradiance_W_m2.rows();
  hours_.reserve(drivers_->hours.size());
  for (std::size_t i = 0; i < drivers_->hours.size(); ++i) {
    const DriverHour& h = drivers_->hours[i];
    const auto sun = drivers_->irradiance_W_m2.col(static_cast<Eigen::Index>(i));
    const bool begins = i == 0 || h.start - drivers_->hours[i - 1].start != std::chrono::hours{1};
    hours_.push_back(
        {.dry_bulb_C = h.dry_bulb_C,
         .humidity_ratio = h.humidity_ratio,
         .wind_m_s = h.wind_m_s,
         .wet_bulb_C = weather::wet_bulb_C(h.dry_bulb_C, h.humidity_ratio, drivers_->pressure_Pa),
         .occupied_fraction = h.occupied_fraction,
         .lights_W = h.lights_W,
         .plugs_W = h.plugs_W,
         .dark_share = static_cast<float>(dark_share(h)),
         .hours_to_start = static_cast<float>(h.hours_to_start),
         .hours_since_stop = static_cast<float>(h.hours_since_stop),
         .hours_since_start = static_cast<float>(h.hours_since_start),
         .hours_to_stop = static_cast<float>(h.hours_to_stop),
         .day_of_year = h.day_of_year,
         .occupied = h.occupied,
         .heating = h.heating,
         .cooling = h.cooling,
         .sunlit = (sun != 0.0).any(),
         .begins = begins});
    for (Eigen::Index k = 0; k < sides; ++k) irradiance_W_m2_.push_back(sun[k]);
  }
}

Eigen::Index Hourly::step_count() const {
  return static_cast<Eigen::Index>(hours_.size()) * options_.steps_per_hour;
}

void Hourly::prepare(const Building& building, std::span<const Alteration* const> alterations,
                     std::size_t hour) {
  building_ = building;
  for (const Alteration* alteration : alterations) {
    if (alteration->rebuilt().contains(elapsed_days(drivers_->hours[hour]))) {
      alteration->rebuild(building_);
    }
  }
  const Building& b = building_;
  const SetPoints& set = b.set_points;
  const double always = b.air ? std::clamp(b.air->outdoor_air_unoccupied_fraction, 0.0, 1.0) : 0.0;
  part_count_ = always > 0.0 && always < 1.0 ? 2 : 1;
  parts_ = part_count_ == 2 ? std::array<Part, 2>{{{always, true}, {1.0 - always, false}}}
                            : std::array<Part, 2>{{{1.0, always >= 1.0}, {0.0, false}}};
  zones_.describe(b, drivers_->orientations, 3600.0 / options_.steps_per_hour, part_count_);
  plant_ = Plant{b};
  leakage_ = leakage_flow(b.storeys);
  mean_people_share_ = weekly_mean(b.occupied_fraction);
  middle_C_ = 0.5 * (set.cooling_occupied_C + set.heating_occupied_C);
  hot_water_day_ = 0;

  standing_ = {.solar_share = 1.0,
               .cooling_occupied_C = set.cooling_occupied_C,
               .cooling_unoccupied_C = set.cooling_unoccupied_C,
               .heating_occupied_C = set.heating_occupied_C,
               .heating_unoccupied_C = set.heating_unoccupied_C,
               .outdoor_air_m3_s = b.ventilation_m3_s,
               .economiser_lockout_C = -std::numeric_limits<double>::infinity(),
               .economiser_share = 1.0,
               .latent_share = 1.0,
               .infiltration_factor = 1.0,
               .ground_C = b.ground_temperature_C};
  if (!b.air) return;
  const AirSystem& air = *b.air;
  standing_.outdoor_air_m3_s = air.outdoor_air_m3_s;
  standing_.supply_C = air.supply_temperature_C;
  most_flow_m3_s_ = air.supply_flow_design_m3_s;
  standing_.least_flow_m3_s =
      std::max(air.supply_flow_min_m3_s, 1e-3 * air.supply_flow_design_m3_s);
  standing_.coil_humidity_ratio = weather::humidity_ratio(
      air.supply_temperature_C, kCoilRelativeHumidity, drivers_->pressure_Pa);
  if (air.economiser_lockout_C) standing_.economiser_lockout_C = *air.economiser_lockout_C;
  if (air.humidification_kg_kg) standing_.humidifier_kg_kg = *air.humidification_kg_kg;
}

std::size_t Hourly::rebuilt_until(std::size_t from, std::size_t to,
                                  std::span<const Alteration* const> alterations) const {
  const auto begin = drivers_->hours.begin();
  const auto first = begin + static_cast<std::ptrdiff_t>(from) + 1;
  auto until = begin + static_cast<std::ptrdiff_t>(to);
  const double now = elapsed_days(begin[static_cast<std::ptrdiff_t>(from)]);
  for (const Alteration* alteration : alterations) {
    const DayRange range = alteration->rebuilt();
    for (const double day : {range.from, range.to}) {
      if (day > now) until = std::ranges::lower_bound(first, until, day, {}, elapsed_days);
    }
  }
  return static_cast<std::size_t>(until - begin);
}

/// The plant's day: its timetable, with early start and late stop; supply air is
/// warmer on cold days.
void Hourly::follow_timetable(const Hour& hour, StepOperation& operation) const {
  const SetPoints& set = building_.set_points;
  operation.daytime_share =
      hour.occupied ? std::max(1.0 - covered(-set.start_early_h, hour.hours_since_start) -
                                   covered(-set.stop_late_h, hour.hours_to_stop),
                               0.0)
                    : std::max(covered(set.start_early_h, hour.hours_to_start),
                               covered(set.stop_late_h, hour.hours_since_stop));
  if (building_.air && operation.dry_bulb_C < kResetFrom_C) {
    operation.supply_C += building_.air->supply_reset_K *
                          std::min((kResetFrom_C - operation.dry_bulb_C) / kResetOver_K, 1.0);
  }
}

/// Plant that is off for a season: set-points out of reach, outdoor air untreated.
void Hourly::switch_off(const Hour& hour, StepOperation& operation) {
  constexpr double kOutOfReach_K = 100.0;
  if (!hour.heating) {
    operation.heating_occupied_C = operation.heating_unoccupied_C = -kOutOfReach_K;
  }
  if (!hour.cooling) {
    operation.cooling_occupied_C = operation.cooling_unoccupied_C = kOutOfReach_K;
    operation.supply_C = std::max(operation.supply_C, operation.dry_bulb_C);
  }
}

void Hourly::switch_off(const Hour& hour, StepLoads& loads) {
  if (!hour.heating) {
    loads.zone_heating_W = loads.reheat_W = loads.preheat_W = loads.humidification_W = 0.0;
  }
  if (!hour.cooling) loads.sensible_cooling_W = loads.latent_cooling_W = 0.0;
}

/// Rooms that float at night warm up slowly, and their handlers start with shut dampers.
Hourly::Morning Hourly::morning_of(const Hour& hour) const {
  const SetPoints& set = building_.set_points;
  const bool before_start = !hour.occupied && hour.hours_to_start < hour.hours_since_stop;
  if (!hour.occupied && !before_start) return {};
  const double since_start_h =
      (hour.occupied ? hour.hours_since_start : -hour.hours_to_start) + set.start_early_h;
  Morning morning;
  if (set.warm_up_h > 0.0) {
    morning.climbed = std::clamp(since_start_h / set.warm_up_h, 0.0, 1.0);
  }
  morning.open = 1.0 - closed_share(set.closed_start_h, since_start_h);
  return morning;
}

StepOperation Hourly::operation_of(std::size_t hour, int step) const {
  const Hour& h = hours_[hour];
  StepOperation operation = standing_;
  operation.dry_bulb_C = h.dry_bulb_C;
  operation.humidity_ratio = h.humidity_ratio;
  operation.wind_m_s = h.wind_m_s;
  operation.people_share = h.occupied_fraction;
  operation.lights_W = building_.use.lights_scale * h.lights_W;
  operation.plugs_W = building_.use.plugs_scale * h.plugs_W;
  operation.exterior_W = 1000.0 * building_.use.exterior_kW * h.dark_share;
  follow_timetable(h, operation);
  switch_off(h, operation);
  if (options_.steps_per_hour == 1) return operation;

  // Interpolates the weather between the middles of hours; constant at the ends of a stretch.
  const double from_middle_h = (step + 0.5) / options_.steps_per_hour - 0.5;
  const bool earlier = from_middle_h < 0.0;
  const bool alone = earlier ? h.begins : hour + 1 == hours_.size() || hours_[hour + 1].begins;
  if (!alone) {
    const Hour& other = hours_[earlier ? hour - 1 : hour + 1];
    const double share = std::abs(from_middle_h);
    operation.dry_bulb_C += share * (other.dry_bulb_C - h.dry_bulb_C);
    operation.humidity_ratio += share * (other.humidity_ratio - h.humidity_ratio);
  }
  return operation;
}

ZoneTotals Hourly::solve_zones(std::size_t hour, const StepOperation& operation,
                               const Morning& morning, double served_share) {
  const Use& use = building_.use;
  const bool boxes = has_reheat_boxes(building_);
  const double closets = boxes ? use.closet_share : 0.0;
  const std::size_t sides = drivers_->orientations.size();
  const double people_W = building_.floor_area_m2 * use.occupancy_person_m2 *
                          use.sensible_W_person * operation.people_share;
  zones_.expose({.dry_bulb_C = operation.dry_bulb_C,
                 .ground_C = operation.ground_C,
                 .internal_W = people_W +
                               use.zone_heat_share *
                                   (operation.lights_W + (1.0 - closets) * operation.plugs_W) +
                               operation.zone_gain_W,
                 .solar_share = operation.solar_share,
                 .irradiance_W_m2 = std::span{irradiance_W_m2_}.subspan(
                     hour * sides, hours_[hour].sunlit ? sides : 0)});

  const double wind2_m2_s2 = operation.wind_m_s * operation.wind_m_s;
  const double leakage_W_K_cm2 =
      heat_capacity_J_m3K_ * operation.infiltration_factor *
      leakage_.per_area_m3_s(middle_C_ - operation.dry_bulb_C, wind2_m2_s2);
  const double least_m3_s = std::max(operation.least_flow_m3_s, operation.outdoor_air_m3_s);
  const double most_m3_s = std::max(most_flow_m3_s_, least_m3_s);
  const double unit_fans_W = building_.air && !boxes ? 1000.0 * building_.air->fan_design_kW : 0.0;
  ZoneTotals totals;
  for (int p = 0; p < part_count_; ++p) {
    const Part& part = parts_[static_cast<std::size_t>(p)];
    const double served = part.always ? 1.0 : served_share;
    const double direct_share =
        building_.air ? (1.0 - building_.air->heat_recovery) * (part.always ? 1.0 : morning.open)
                      : 1.0;
    const double daytime_heating_C =
        between(part.always ? 1.0 : morning.climbed, operation.heating_occupied_C,
                operation.heating_unoccupied_C);
    const double heating_C = between(served, daytime_heating_C, operation.heating_unoccupied_C);
    const double cooling_C =
        between(served, operation.cooling_occupied_C, operation.cooling_unoccupied_C);
    // Without handlers for many rooms, outdoor air meets the zone.
    const double direct_m3_s = (boxes ? 0.0 : served * direct_share * operation.outdoor_air_m3_s) +
                               (1.0 - served) * operation.idle_outdoor_air_m3_s;
    const ZoneService service{.leakage_W_K_cm2 = leakage_W_K_cm2,
                              .outdoor_W_K = heat_capacity_J_m3K_ * direct_m3_s,
                              .heating_C = heating_C,
                              .cooling_C = std::max(cooling_C, heating_C),
                              .supply_C = operation.supply_C,
                              .least_W_K = heat_capacity_J_m3K_ * served * least_m3_s,
                              .most_W_K = heat_capacity_J_m3K_ * most_m3_s,
                              .scheduled_share = served,
                              .fan_W = served * unit_fans_W};
    totals.add(part.share, boxes ? zones_.serve_with_boxes(p, service) : zones_.serve(p, service));
  }
  if (closets > 0.0)
    serve_closets(closets * use.zone_heat_share * operation.plugs_W, operation, totals);
  return totals;
}

/// Closets get the supply air that keeps them at the daytime set-point, at night on call.
void Hourly::serve_closets(double heat_W, const StepOperation& operation,
                           ZoneTotals& totals) const {
  const double flow_W_K =
      heat_W / std::max(operation.cooling_occupied_C - operation.supply_C, kLeastLift_K);
  const double always = parts_[0].always ? parts_[0].share : 0.0;
  const double served = always + (1.0 - always) * std::clamp(operation.daytime_share, 0.0, 1.0);
  totals.scheduled_W_K += served * flow_W_K;
  totals.scheduled_return_W += served * flow_W_K * operation.cooling_occupied_C;
  totals.on_call_W_K += (1.0 - served) * flow_W_K;
  totals.on_call_return_W += (1.0 - served) * flow_W_K * operation.cooling_occupied_C;
}

StepLoads Hourly::solve_step(std::size_t hour, int step,
                             std::span<const Alteration* const> alterations) {
  StepOperation operation = operation_of(hour, step);
  for (const Alteration* alteration : alterations) {
    alteration->operate(drivers_->hours[hour], operation);
  }
  const double served_share = std::clamp(operation.daytime_share, 0.0, 1.0);
  const Morning morning = morning_of(hours_[hour]);
  const ZoneTotals zones = solve_zones(hour, operation, morning, served_share);
  if (hot_water_day_ != hours_[hour].day_of_year) {
    hot_water_day_ = hours_[hour].day_of_year;
    hot_water_W_ = hot_water_W(building_.hot_water, hot_water_day_);
  }

  // Hot water is drawn when people are there.
  const double draw_share =
      mean_people_share_ > 0.0 ? operation.people_share / mean_people_share_ : 1.0;
  StepLoads loads{.lights_W = operation.lights_W,
                  .plugs_W = operation.plugs_W,
                  .exterior_W = operation.exterior_W,
                  .sensible_cooling_W = zones.cooling_W,
                  .zone_heating_W = zones.zone_heating_W,
                  .hot_water_W = draw_share * hot_water_W_,
                  .base_heat_W = 1000.0 * building_.base_heat_kW,
                  .mean_zone_C = zones.mean_air_C,
                  .hot_water_litres_share = draw_share,
                  .cooling_cost_factor = chiller_cost(building_, hours_[hour].wet_bulb_C),
                  .heating_cost_factor = 1.0};
  if (building_.air) {
    const double always = building_.air->outdoor_air_unoccupied_fraction;
    const double running_share = always + (1.0 - always) * served_share;
    const double latent_W = building_.floor_area_m2 * building_.use.occupancy_person_m2 *
                            building_.use.latent_W_person * operation.people_share;
    const double day_share = running_share > 0.0 ? 1.0 - always / running_share : 0.0;
    StepOperation dampers = operation;
    const double open = 1.0 - day_share * (1.0 - morning.open);
    dampers.outdoor_air_m3_s *= open;
    dampers.economiser_share *= open;
    if (has_reheat_boxes(building_)) {
      add_air_handlers(*building_.air, heat_capacity_J_m3K_, running_share, zones, latent_W,
                       dampers, loads);
    } else {
      add_room_units(*building_.air, coil_lift_K(building_), heat_capacity_J_m3K_, running_share,
                     zones, latent_W, dampers, loads);
    }
  }
  switch_off(hours_[hour], loads);
  for (const Alteration* alteration : alterations) {
    alteration->supply(building_, drivers_->hours[hour], operation, loads);
  }
  return loads;
}

template <class Sink>
void Hourly::run_hours(std::size_t from, std::size_t to,
                       std::span<const Alteration* const> alterations, Sink sink) {
  for (std::size_t hour = from; hour < to; ++hour) {
    for (int step = 0; step < options_.steps_per_hour; ++step) {
      sink(hour, step, solve_step(hour, step, alterations));
    }
  }
}

/// Runs each stretch without a jump in time: first a warm-up from the middle
/// set-point, then for real.
template <class Sink>
void Hourly::simulate(const Building& building, std::span<const Alteration* const> alterations,
                      Sink sink) {
  for (std::size_t from = 0; from < hours_.size();) {
    std::size_t to = from + 1;
    while (to < hours_.size() && !hours_[to].begins) ++to;
    prepare(building, alterations, from);
    zones_.reset(middle_C_);
    run_hours(from, std::min(to, from + kWarmUp_h), alterations,
              [](std::size_t, int, const StepLoads&) {});
    for (std::size_t hour = from; hour < to;) {
      if (hour > from) prepare(building, alterations, hour);
      const std::size_t until = rebuilt_until(hour, to, alterations);
      run_hours(hour, until, alterations, sink);
      hour = until;
    }
    from = to;
  }
}

void Hourly::read_meters(std::span<const MeterMap> meters) {
  meters_kW_W_.resize(meters.size());
  for (std::size_t m = 0; m < meters.size(); ++m) {
    for (std::size_t use = 0; use < kEndUses; ++use) {
      meters_kW_W_[m][static_cast<Eigen::Index>(use)] = 1e-3 * meters[m][static_cast<EndUse>(use)];
    }
  }
}

void Hourly::run(const Building& building, std::span<const Alteration* const> alterations,
                 std::span<const MeterMap> meters, Eigen::Ref<Eigen::ArrayXXd> power_kW) {
  assert(power_kW.rows() == step_count());
  assert(power_kW.cols() == static_cast<Eigen::Index>(meters.size()));
  read_meters(meters);
  simulate(building, alterations, [&](std::size_t hour, int step, const StepLoads& loads) {
    const EndUsePower_W power_W = plant_.metered_W(loads);
    const auto row = static_cast<Eigen::Index>(hour) * options_.steps_per_hour + step;
    for (std::size_t m = 0; m < meters_kW_W_.size(); ++m) {
      power_kW(row, static_cast<Eigen::Index>(m)) = (meters_kW_W_[m] * power_W).sum();
    }
  });
  for (std::size_t m = 0; m < meters.size(); ++m) {
    const std::span<double> column{power_kW.col(static_cast<Eigen::Index>(m)).data(),
                                   static_cast<std::size_t>(power_kW.rows())};
    for (const Alteration* alteration : alterations) {
      alteration->record(drivers_->hours, static_cast<int>(m), column);
    }
  }
}

void Hourly::run_end_uses(const Building& building, std::span<const Alteration* const> alterations,
                          std::span<EndUseEnergy> months) {
  assert(months.size() == drivers_->months.size());
  std::ranges::fill(months, EndUseEnergy{});
  const double to_kWh = 1e-3 / options_.steps_per_hour;
  simulate(building, alterations, [&](std::size_t hour, int, const StepLoads& loads) {
    const EndUsePower_W power_W = plant_.metered_W(loads);
    EndUseEnergy& energy = months[static_cast<std::size_t>(drivers_->hours[hour].month)];
    for (std::size_t use = 0; use < kEndUses; ++use) {
      energy[static_cast<EndUse>(use)] += to_kWh * power_W[static_cast<Eigen::Index>(use)];
    }
  });
}

}  // namespace recald::model::hourly
