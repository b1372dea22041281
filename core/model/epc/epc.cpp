#include "core/model/epc/epc.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numbers>

#include "core/model/epc/air_system.hpp"
#include "core/model/epc/set_back.hpp"
#include "core/model/epc/utilisation.hpp"
#include "core/weather/psychrometrics.hpp"

namespace recald::model::epc {
namespace {

using weather::kVaporisationHeat_J_kg;

constexpr double kCoilRelativeHumidity = 0.95;  // of air that leaves a wet coil
// Beyond this, the hours' own pattern no longer shows when the month's cooling occurs.
constexpr double kLargestCoolingScale = 4.0;
constexpr double kWarmestWaterDay = 230.0;  // day of year, cold-water mains lag the air
constexpr double kWaterHeat_kWh_m3K = 1.163;

double mains_temperature_C(const HotWater& water, double day_of_year) {
  return water.mains_C +
         water.mains_amplitude_K *
             std::cos(2.0 * std::numbers::pi * (day_of_year - kWarmestWaterDay) / 365.0);
}

double hot_water_kWh(const Building& building, const ClimateMonth& month) {
  const HotWater& water = building.hot_water;
  const double lift_K = water.temperature_C - mains_temperature_C(water, month.day_of_year_mid);
  return kWaterHeat_kWh_m3K * water.volume_m3_day * month.days * lift_K /
         (water.efficiency * building.heating_efficiency);
}

}  // namespace

struct Epc::MonthlySums {
  double hours = 0.0;
  double gains_Wh = 0.0;
  double heating_transfer_Wh = 0.0;  ///< Out of the zone, at the heating set-point.
  double cooling_transfer_Wh = 0.0;  ///< At the cooling set-point.
  double conductance_Wh_K = 0.0;
};

struct Epc::AirTotals {
  double coil_Wh = 0.0;
  double latent_Wh = 0.0;
  double reheat_Wh = 0.0;
  double preheat_Wh = 0.0;
  double humidification_Wh = 0.0;
  double fan_Wh = 0.0;
  double pump_Wh = 0.0;
};

Epc::Epc(std::shared_ptr<const ClimateClasses> climate)
    : climate_(std::move(climate)),
      heat_capacity_J_m3K_(weather::air_heat_capacity_J_m3K(climate_->pressure_Pa)),
      leakage_m3_s_per_cm2_(climate_->classes.size()) {}

void Epc::evaluate(const Building& building, std::span<EndUseEnergy> months) {
  assert(months.size() == month_count());
  const std::size_t zones = zone_count(building, climate_->orientations);
  if (zones != zones_.size()) {
    zones_.resize(zones);
    for (Zone& zone : zones_) zone.solar_aperture_m2.resize(climate_->orientations.size());
    spreads_.resize(zones);
    balance_.resize(zones * climate_->classes.size());
  }
  describe_zones(building, climate_->orientations, zones_);
  find_leakage_per_area(building);
  if (building.air) {
    coil_humidity_ratio_ = weather::humidity_ratio(building.air->supply_temperature_C,
                                                   kCoilRelativeHumidity, climate_->pressure_Pa);
  }
  for (std::size_t i = 0; i < months.size(); ++i) {
    months[i] = EndUseEnergy{};
    evaluate_month(building, climate_->months[i], months[i]);
  }
}

void Epc::find_leakage_per_area(const Building& building) {
  const LeakageFlow flow = leakage_flow(building.storeys);
  const SetPoints& set = building.set_points;
  const double middle_C = 0.5 * (set.cooling_occupied_C + set.heating_occupied_C);
  for (std::size_t i = 0; i < leakage_m3_s_per_cm2_.size(); ++i) {
    const ClimateClass& c = climate_->classes[i];
    leakage_m3_s_per_cm2_[i] = flow.per_area_m3_s(middle_C - c.dry_bulb_C, c.wind2_m2_s2);
  }
}

void Epc::fill_gains(const Building& building, const Zone& zone, const ClimateState& state,
                     double fan_W, ClassBalance* balance) const {
  const Use& use = building.use;
  const double people_W = building.floor_area_m2 * use.occupancy_person_m2 * use.sensible_W_person;
  for (int i = state.first_class; i < state.first_class + state.classes; ++i) {
    const ClimateClass& c = climate_->classes[static_cast<std::size_t>(i)];
    double gains_W =
        zone.floor_share *
            (fan_W + people_W * c.occupied_fraction +
             use.zone_heat_share * (use.lights_scale * c.lights_W + use.plugs_scale * c.plugs_W)) -
        zone.sky_loss_W;
    const std::span<const double> irradiance = climate_->irradiance(i);
    for (std::size_t k = 0; k < irradiance.size(); ++k) {
      gains_W += zone.solar_aperture_m2[k] * irradiance[k];
    }
    balance[i].gains_W = gains_W;
  }
}

Epc::HeldTemperatures Epc::unoccupied_temperatures(const Building& building, const Zone& zone,
                                                   const ClimateMonth& month,
                                                   const ClassBalance* balance) const {
  const SetPoints& set = building.set_points;
  if (month.stretches.empty()) return {set.cooling_occupied_C, set.heating_occupied_C};

  const ClimateState& state = month.unoccupied;
  double gains_Wh = 0.0;
  double leakage_m3_s_per_cm2 = 0.0;
  for (int i = state.first_class; i < state.first_class + state.classes; ++i) {
    const double hours = climate_->classes[static_cast<std::size_t>(i)].hours;
    gains_Wh += hours * balance[i].gains_W;
    leakage_m3_s_per_cm2 += hours * leakage_m3_s_per_cm2_[static_cast<std::size_t>(i)];
  }
  const double outdoor_W_K = zone.transmission_W_K + heat_capacity_J_m3K_ * zone.leakage_cm2 *
                                                         leakage_m3_s_per_cm2 / state.hours;
  const double total_W_K = outdoor_W_K + zone.ground_W_K;
  const double capacity_J_K =
      zone.floor_share * building.floor_area_m2 * building.heat_capacity_J_m2K;
  // A core without envelope drifts by its gains alone, at a rate that soon reaches the limit.
  const double conductance_W_K = std::max(total_W_K, 1e-3 * capacity_J_K / 3600.0);
  const double tau_h = capacity_J_K / 3600.0 / conductance_W_K;
  const double inward_W = gains_Wh / state.hours + zone.ground_W_K * building.ground_temperature_C;

  HeldTemperatures mean{0.0, 0.0};
  for (const StretchClass& s : month.stretches) {
    const double free_C = (outdoor_W_K * s.dry_bulb_C + inward_W) / conductance_W_K;
    const double heating_C = mean_drift_temperature_C(
        set.heating_occupied_C, set.heating_unoccupied_C, free_C, tau_h, s.length_h);
    const double cooling_C = mean_drift_temperature_C(
        set.cooling_occupied_C, set.cooling_unoccupied_C, free_C, tau_h, s.length_h);
    mean.heating_C += s.hours * std::min(heating_C, set.heating_occupied_C);
    mean.cooling_C += s.hours * std::max(cooling_C, set.cooling_occupied_C);
  }
  return {mean.cooling_C / state.hours, mean.heating_C / state.hours};
}

void Epc::balance_state(const Building& building, const Zone& zone, const ClimateState& state,
                        const HeldTemperatures& held, double ventilation_m3_s,
                        ClassBalance* balance) const {
  const double ground_C = building.ground_temperature_C;
  const double to_ground_cooling_W = zone.ground_W_K * (held.cooling_C - ground_C);
  const double to_ground_heating_W = zone.ground_W_K * (held.heating_C - ground_C);
  for (int i = state.first_class; i < state.first_class + state.classes; ++i) {
    const ClimateClass& c = climate_->classes[static_cast<std::size_t>(i)];
    const double infiltration_m3_s =
        zone.leakage_cm2 * leakage_m3_s_per_cm2_[static_cast<std::size_t>(i)];
    ClassBalance& b = balance[i];
    b.conductance_W_K =
        zone.transmission_W_K + heat_capacity_J_m3K_ * (infiltration_m3_s + ventilation_m3_s);
    b.cooling_balance_W =
        b.gains_W - b.conductance_W_K * (held.cooling_C - c.dry_bulb_C) - to_ground_cooling_W;
    b.heating_balance_W =
        b.conductance_W_K * (held.heating_C - c.dry_bulb_C) + to_ground_heating_W - b.gains_W;
    const double total_W_K = b.conductance_W_K + zone.ground_W_K;
    b.running_cooling_W =
        b.cooling_balance_W + total_W_K * (held.cooling_C - building.set_points.cooling_occupied_C);
    b.running_heating_W =
        b.heating_balance_W + total_W_K * (building.set_points.heating_occupied_C - held.heating_C);
  }
}

Epc::MonthlySums Epc::sum_month(const ClimateMonth& month, const ClassBalance* balance) const {
  MonthlySums sums;
  for (const ClimateState* state : {&month.occupied, &month.unoccupied}) {
    for (int i = state->first_class; i < state->first_class + state->classes; ++i) {
      const double hours = climate_->classes[static_cast<std::size_t>(i)].hours;
      const ClassBalance& b = balance[i];
      sums.hours += hours;
      sums.gains_Wh += hours * b.gains_W;
      sums.heating_transfer_Wh += hours * (b.heating_balance_W + b.gains_W);
      sums.cooling_transfer_Wh += hours * (b.gains_W - b.cooling_balance_W);
      sums.conductance_Wh_K += hours * b.conductance_W_K;
    }
  }
  return sums;
}

void Epc::evaluate_zone(const Building& building, std::size_t index, const ClimateMonth& month,
                        EndUseEnergy& energy) {
  const Zone& zone = zones_[index];
  ClassBalance* balance = balances(index);
  const bool units = building.air && !building.air->has_reheat_boxes;
  const double running = building.air ? building.air->outdoor_air_unoccupied_fraction : 0.0;
  const double fan_W = units ? 1000.0 * building.air->fan_design_kW : 0.0;
  fill_gains(building, zone, month.occupied, fan_W, balance);
  fill_gains(building, zone, month.unoccupied, running * fan_W, balance);
  const HeldTemperatures occupied{building.set_points.cooling_occupied_C,
                                  building.set_points.heating_occupied_C};
  const HeldTemperatures drifting = unoccupied_temperatures(building, zone, month, balance);
  const HeldTemperatures unoccupied{
      running * occupied.cooling_C + (1.0 - running) * drifting.cooling_C,
      running * occupied.heating_C + (1.0 - running) * drifting.heating_C};
  // With air handlers, outdoor air meets their coils first; with units or without, the zone.
  const double ventilation_m3_s = units ? zone.floor_share * (1.0 - building.air->heat_recovery) *
                                              building.air->outdoor_air_m3_s
                                  : building.air ? 0.0
                                                 : building.ventilation_m3_s;
  balance_state(building, zone, month.occupied, occupied, ventilation_m3_s, balance);
  balance_state(building, zone, month.unoccupied, unoccupied, running * ventilation_m3_s, balance);

  const MonthlySums sums = sum_month(month, balance);
  const double capacity_Wh_K =
      zone.floor_share * building.floor_area_m2 * building.heat_capacity_J_m2K / 3600.0;
  const double total_W_K = sums.conductance_Wh_K / sums.hours + zone.ground_W_K;
  const double a = utilisation_exponent(capacity_Wh_K / std::max(total_W_K, 1e-9));
  const double gains_kWh = 1e-3 * sums.gains_Wh;
  const double cooling_kWh = cooling_need_kWh(1e-3 * sums.cooling_transfer_Wh, gains_kWh, a);
  energy[EndUse::zone_heating] += heating_need_kWh(1e-3 * sums.heating_transfer_Wh, gains_kWh, a);
  const double free_share = units ? free_cooling_share(building, zone, month, balance) : 0.0;
  energy[EndUse::sensible_cooling] += (1.0 - free_share) * cooling_kWh;
  if (has_reheat_boxes(building)) {
    spreads_[index] = spread_cooling(building, month, balance, cooling_kWh);
  }
}

void Epc::evaluate_month(const Building& building, const ClimateMonth& month,
                         EndUseEnergy& energy) {
  for (std::size_t zone = 0; zone < zones_.size(); ++zone) {
    evaluate_zone(building, zone, month, energy);
  }
  double hours = 0.0;
  for (const ClimateState* state : {&month.occupied, &month.unoccupied}) {
    hours += state->hours;
    for (int i = state->first_class; i < state->first_class + state->classes; ++i) {
      const ClimateClass& c = climate_->classes[static_cast<std::size_t>(i)];
      energy[EndUse::lighting] += 1e-3 * c.hours * building.use.lights_scale * c.lights_W;
      energy[EndUse::plugs] += 1e-3 * c.hours * building.use.plugs_scale * c.plugs_W;
    }
  }
  energy[EndUse::exterior] = hours * building.use.exterior_kW;
  energy[EndUse::base_heat] = hours * building.base_heat_kW;
  energy[EndUse::hot_water] = hot_water_kWh(building, month);
  if (has_reheat_boxes(building)) {
    add_air_side(building, month, energy);
  } else if (building.air) {
    add_room_units(building, month, energy);
  }

  // If the plant is off for part of a month, that part of the need is dropped.
  const double heating_factor =
      month.heating_share * (1.0 + building.heating_loss_fraction) / building.heating_efficiency;
  for (const EndUse use :
       {EndUse::zone_heating, EndUse::reheat, EndUse::preheat, EndUse::humidification}) {
    energy[use] *= heating_factor;
  }
  for (const EndUse use : {EndUse::sensible_cooling, EndUse::latent_cooling}) {
    energy[use] *= month.cooling_share * (1.0 + building.cooling_loss_fraction);
  }
  if (building.chiller_cop) {
    energy[EndUse::chiller] =
        (energy[EndUse::sensible_cooling] + energy[EndUse::latent_cooling]) / *building.chiller_cop;
  }
}

Epc::CoolingSpread Epc::spread_cooling(const Building& building, const ClimateMonth& month,
                                       const ClassBalance* balance, double cooling_need_kWh) const {
  double load_Wh = 0.0;
  for (const ClimateState* state : {&month.occupied, &month.unoccupied}) {
    const double running =
        state == &month.occupied ? 1.0 : building.air->outdoor_air_unoccupied_fraction;
    for (int i = state->first_class; i < state->first_class + state->classes; ++i) {
      load_Wh += running * climate_->classes[static_cast<std::size_t>(i)].hours *
                 std::max(balance[i].running_cooling_W, 0.0);
    }
  }
  const double need_Wh = 1e3 * cooling_need_kWh;
  const double scale = load_Wh > 0.0 ? std::min(need_Wh / load_Wh, kLargestCoolingScale) : 0.0;

  // The rest, which the hours' own loads cannot carry, is spread evenly over the hours with fans.
  const double running_hours =
      month.occupied.hours + building.air->outdoor_air_unoccupied_fraction * month.unoccupied.hours;
  return {scale, std::max(need_Wh - scale * load_Wh, 0.0) / std::max(running_hours, 1.0)};
}

void Epc::add_air_side(const Building& building, const ClimateMonth& month, EndUseEnergy& energy) {
  AirTotals totals;
  add_air_state(building, month.occupied, 1.0, totals);
  add_air_state(building, month.unoccupied, building.air->outdoor_air_unoccupied_fraction, totals);
  energy[EndUse::sensible_cooling] = 1e-3 * totals.coil_Wh;
  energy[EndUse::latent_cooling] = 1e-3 * totals.latent_Wh;
  energy[EndUse::reheat] = 1e-3 * totals.reheat_Wh;
  energy[EndUse::preheat] = 1e-3 * totals.preheat_Wh;
  energy[EndUse::humidification] = 1e-3 * totals.humidification_Wh;
  energy[EndUse::fans] = 1e-3 * totals.fan_Wh;
  energy[EndUse::pumps] = 1e-3 * totals.pump_Wh;
}

/// Share of the zone's cooling that an economiser's extra outdoor air saves.
double Epc::free_cooling_share(const Building& building, const Zone& zone,
                               const ClimateMonth& month, const ClassBalance* balance) const {
  const AirSystem& air = *building.air;
  if (!air.economiser_lockout_C) return 0.0;
  const double room_C = building.set_points.cooling_occupied_C;
  const double spare_W_K = heat_capacity_J_m3K_ * zone.floor_share *
                           std::max(air.supply_flow_design_m3_s - air.outdoor_air_m3_s, 0.0);
  double load_Wh = 0.0;
  double free_Wh = 0.0;
  for (const ClimateState* state : {&month.occupied, &month.unoccupied}) {
    const double running = state == &month.occupied ? 1.0 : air.outdoor_air_unoccupied_fraction;
    for (int i = state->first_class; i < state->first_class + state->classes; ++i) {
      const ClimateClass& c = climate_->classes[static_cast<std::size_t>(i)];
      const double load_W = std::max(balance[i].cooling_balance_W, 0.0);
      load_Wh += c.hours * load_W;
      if (c.dry_bulb_C >= *air.economiser_lockout_C) continue;
      const double saved_W = running * spare_W_K * std::max(room_C - c.dry_bulb_C, 0.0);
      free_Wh += c.hours * std::min(saved_W, load_W);
    }
  }
  return load_Wh > 0.0 ? free_Wh / load_Wh : 0.0;
}

/// What the coils condense in a state, as heat. @see hourly::add_room_units
double Epc::moisture_Wh(const Building& building, const ClimateState& state, double running_share,
                        double coil_W) const {
  if (state.classes == 0 || running_share <= 0.0 || coil_W <= 0.0) return 0.0;
  double people_h = 0.0;
  for (int i = state.first_class; i < state.first_class + state.classes; ++i) {
    const ClimateClass& c = climate_->classes[static_cast<std::size_t>(i)];
    people_h += c.hours * c.occupied_fraction;
  }
  const Use& use = building.use;
  const double people_W = building.floor_area_m2 * use.occupancy_person_m2 * use.latent_W_person *
                          people_h / state.hours;
  const double outdoor_kg_s = heat_capacity_J_m3K_ / weather::kAirHeatCapacity_J_kgK *
                              building.air->outdoor_air_m3_s * running_share;
  const double outdoor_W = std::max(outdoor_kg_s, 1e-6) * kVaporisationHeat_J_kg;
  return outdoor_W * state.excess_over(coil_humidity_ratio_ - people_W / outdoor_W) * coil_W /
         (outdoor_W + coil_W);
}

void Epc::add_room_units(const Building& building, const ClimateMonth& month,
                         EndUseEnergy& energy) const {
  const AirSystem& air = *building.air;
  const double always = air.outdoor_air_unoccupied_fraction;
  const double running_h = month.occupied.hours + always * month.unoccupied.hours;
  const double lift_K = coil_lift_K(building);
  const double cooling_kWh = energy[EndUse::sensible_cooling];
  const double design_kW = 1e-3 * heat_capacity_J_m3K_ * air.supply_flow_design_m3_s * lift_K;
  energy[EndUse::fans] = air.fan_design_kW * running_h;
  const double driven_kWh =
      month.cooling_share * cooling_kWh + month.heating_share * energy[EndUse::zone_heating];
  energy[EndUse::pumps] = air.pump_design_kW * driven_kWh / std::max(design_kW, 1e-3);

  // What passes through the coils for the month's sensible load, as moisture it could carry.
  const double coil_W = 1e3 * cooling_kWh / std::max(running_h, 1.0) / lift_K *
                        kVaporisationHeat_J_kg / weather::kAirHeatCapacity_J_kgK;
  energy[EndUse::latent_cooling] =
      1e-3 * (moisture_Wh(building, month.occupied, 1.0, coil_W) +
              moisture_Wh(building, month.unoccupied, always, always * coil_W));
  if (air.humidification_kg_kg) {
    const double outdoor_W = heat_capacity_J_m3K_ / weather::kAirHeatCapacity_J_kgK *
                             air.outdoor_air_m3_s * kVaporisationHeat_J_kg;
    energy[EndUse::humidification] =
        1e-3 * outdoor_W *
        (month.occupied.shortfall_under(*air.humidification_kg_kg) +
         always * month.unoccupied.shortfall_under(*air.humidification_kg_kg));
  }
}

Epc::AirDemand Epc::boxes_of_class(const Building& building, int class_index) {
  const AirSystem& air = *building.air;
  const double least_m3_s = std::max(
      {air.supply_flow_min_m3_s, air.outdoor_air_m3_s, 1e-3 * air.supply_flow_design_m3_s});
  const double most_m3_s = std::max(air.supply_flow_design_m3_s, least_m3_s);
  AirDemand sum{};
  for (std::size_t z = 0; z < zones_.size(); ++z) {
    const Zone& zone = zones_[z];
    const ClassBalance& b = balances(z)[class_index];
    const CoolingSpread& spread = spreads_[z];
    const BoxRates box = box_rates(
        {.supply_C = air.supply_temperature_C,
         .least_m3_s = zone.floor_share * least_m3_s,
         .most_m3_s = zone.floor_share * most_m3_s},
        heat_capacity_J_m3K_,
        {.cooling_load_W = spread.scale * std::max(b.running_cooling_W, 0.0) + spread.extra_W,
         .shortage_W = std::max(-b.running_cooling_W, 0.0),
         .conductance_W_K = b.conductance_W_K + zone.ground_W_K,
         .cooling_set_point_C = building.set_points.cooling_occupied_C,
         .heating_set_point_C = building.set_points.heating_occupied_C});
    // The zone's own shortage is the monthly need; the rest of the boxes' heat is reheat.
    sum.reheat_W += std::max(box.heating_W - std::max(b.running_heating_W, 0.0), 0.0);
    sum.supply_m3_s += box.flow_m3_s;
    sum.return_C += box.flow_m3_s * box.zone_C;
  }
  sum.return_C /= sum.supply_m3_s;
  return sum;
}

void Epc::add_air_state(const Building& building, const ClimateState& state, double running_share,
                        AirTotals& totals) {
  if (state.classes == 0 || running_share <= 0.0) return;
  const AirSystem& air = *building.air;
  double outdoor_share_sum = 0.0;
  double people_sum = 0.0;
  for (int i = state.first_class; i < state.first_class + state.classes; ++i) {
    const ClimateClass& c = climate_->classes[static_cast<std::size_t>(i)];
    const AirDemand boxes = boxes_of_class(building, i);
    const HandlerRates rates = handler_rates(air, heat_capacity_J_m3K_, running_share,
                                             boxes.supply_m3_s, boxes.return_C, c.dry_bulb_C);
    totals.reheat_Wh += c.hours * running_share * boxes.reheat_W;
    totals.coil_Wh += c.hours * rates.coil_W;
    totals.preheat_Wh += c.hours * rates.preheat_W;
    totals.fan_Wh += c.hours * rates.fan_W;
    totals.pump_Wh += c.hours * rates.pump_W;
    outdoor_share_sum += c.hours * rates.outdoor_air_share;
    people_sum += c.hours * c.occupied_fraction;
  }

  // Moisture: outdoor air more humid than the coil's, and the recirculated share of
  // people's moisture.
  const double people =
      building.floor_area_m2 * building.use.occupancy_person_m2 * people_sum / state.hours;
  const double people_W =
      (1.0 - outdoor_share_sum / state.hours) * building.use.latent_W_person * people;
  const double outdoor_kg_s =
      heat_capacity_J_m3K_ / weather::kAirHeatCapacity_J_kgK * air.outdoor_air_m3_s * running_share;
  const double outdoor_W = std::max(outdoor_kg_s, 1e-6) * kVaporisationHeat_J_kg;
  totals.latent_Wh += outdoor_W * state.excess_over(coil_humidity_ratio_ - people_W / outdoor_W);
  if (air.humidification_kg_kg) {
    totals.humidification_Wh += outdoor_W * state.shortfall_under(*air.humidification_kg_kg);
  }
}

}  // namespace recald::model::epc
