#include "simulators/energyplus/hidden_truth.hpp"

#include <utility>

#include "simulators/chance/chance.hpp"

namespace recald::simulators::energyplus {
namespace {

/// How a quantity differs from the drawings: by a factor or by a difference.
enum class By { factor, difference };

/// Several members that differ together are one quantity.
template <class Parameters>
struct Quantity {
  const char* name;
  const char* unit;  ///< Of the value; a factor's first member stands for all.
  std::vector<double* (*)(Parameters&)> of;
  By by;
  Triangular change;
  std::vector<const char*> targets;  ///< "Type/name/field" in the epJSON.
};

template <class P>
Quantity<P> scaled(const char* name, const char* unit, std::vector<double* (*)(P&)> of,
                   const Triangular& change, const char* targets) {
  return {name, unit, std::move(of), By::factor, change, {targets}};
}

template <class P>
Quantity<P> shifted(const char* name, const char* unit, std::vector<double* (*)(P&)> of,
                    const Triangular& change, const char* targets) {
  return {name, unit, std::move(of), By::difference, change, {targets}};
}

template <class Parameters>
std::vector<Quantity<Parameters>> shared_quantities() {
  using P = Parameters;
  return {
      scaled<P>("infiltration", "m3/s per m2", {[](P& p) { return &p.infiltration_m3_s_m2; }},
                {0.3, 1.0, 2.5},
                "ZoneInfiltration:DesignFlowRate/*/flow_rate_per_exterior_surface_area"),
      shifted<P>("cooling_setpoint", "degC", {[](P& p) { return &p.cooling_setpoint_C; }},
                 {-2.0, 0.0, 2.0}, "Schedule:Constant/Cooling set-point/hourly_value"),
      shifted<P>("heating_setpoint", "degC", {[](P& p) { return &p.heating_setpoint_C; }},
                 {-0.7, 0.0, 0.7}, "Schedule:Constant/Heating set-point/hourly_value"),
      scaled<P>("window_u", "W/m2K", {[](P& p) { return &p.envelope.window_u_W_m2K; }},
                {0.85, 1.0, 1.15}, "WindowMaterial:SimpleGlazingSystem/*/u_factor"),
      scaled<P>("window_shgc", "-", {[](P& p) { return &p.envelope.window_shgc; }},
                {0.85, 1.0, 1.15},
                "WindowMaterial:SimpleGlazingSystem/*/solar_heat_gain_coefficient"),
      scaled<P>("wall_insulation", "m2K/W",
                {[](P& p) { return &p.envelope.wall_insulation_m2K_W; }}, {0.85, 1.0, 1.15},
                "Material:NoMass/Wall insulation/thermal_resistance"),
      scaled<P>("roof_insulation", "m2K/W",
                {[](P& p) { return &p.envelope.roof_insulation_m2K_W; }}, {0.85, 1.0, 1.15},
                "Material:NoMass/Roof insulation/thermal_resistance"),
      shifted<P>("ground_temperature", "degC", {[](P& p) { return &p.ground_C; }}, {-2.0, 0.0, 2.0},
                 "Site:GroundTemperature:BuildingSurface/*/*_ground_temperature")};
}

std::vector<Quantity<LaboratoryParameters>> laboratory_quantities() {
  using P = LaboratoryParameters;
  std::vector<Quantity<P>> quantities{
      scaled<P>("occupancy_office", "person/m2", {[](P& p) { return &p.office_person_m2; }},
                {0.3, 1.0, 1.8}, "People/Offices people/people_per_floor_area"),
      scaled<P>("occupancy_laboratory", "person/m2", {[](P& p) { return &p.laboratory_person_m2; }},
                {0.3, 1.0, 1.8}, "People/Laboratories people/people_per_floor_area"),
      scaled<P>("outdoor_air_office", "m3/s", {[](P& p) { return &p.office_outdoor_m3_s; }},
                {0.4, 1.0, 1.2},
                "Controller:OutdoorAir/Office handler outdoor air "
                "controller/minimum_outdoor_air_flow_rate"),
      scaled<P>("outdoor_air_laboratory_1", "m3/s",
                {[](P& p) { return &p.laboratory_outdoor_m3_s[0]; }}, {0.4, 1.0, 1.2},
                "Controller:OutdoorAir/Laboratory handler 1 outdoor air "
                "controller/minimum_outdoor_air_flow_rate"),
      scaled<P>("outdoor_air_laboratory_2", "m3/s",
                {[](P& p) { return &p.laboratory_outdoor_m3_s[1]; }}, {0.4, 1.0, 1.2},
                "Controller:OutdoorAir/Laboratory handler 2 outdoor air "
                "controller/minimum_outdoor_air_flow_rate"),
      scaled<P>("lighting", "W/m2",
                {[](P& p) { return &p.laboratory_lighting_W_m2; },
                 [](P& p) { return &p.office_lighting_W_m2; }},
                {0.75, 1.0, 1.25}, "Lights/*/watts_per_floor_area"),
      scaled<P>("equipment", "W/m2",
                {[](P& p) { return &p.laboratory_equipment_W_m2; },
                 [](P& p) { return &p.office_equipment_W_m2; }},
                {0.75, 1.0, 1.25}, "ElectricEquipment/*/watts_per_floor_area"),
      shifted<P>("supply_temperature", "degC", {[](P& p) { return &p.supply_air_C; }},
                 {-1.5, 0.0, 1.0}, "Schedule:Constant/*handler* supply temperature/hourly_value"),
      shifted<P>("chilled_water_temperature", "degC", {[](P& p) { return &p.chilled_water_C; }},
                 {-1.0, 0.0, 1.0}, "Schedule:Constant/Chilled water temperature/hourly_value"),
      scaled<P>("fan_pressure", "Pa", {[](P& p) { return &p.fan_pressure_Pa; }}, {0.9, 1.0, 1.1},
                "Fan:VariableVolume/*/pressure_rise")};
  for (const auto& quantity : shared_quantities<P>()) quantities.push_back(quantity);
  return quantities;
}

std::vector<Quantity<SmallOfficeParameters>> small_office_quantities() {
  using P = SmallOfficeParameters;
  std::vector<Quantity<P>> quantities{
      scaled<P>("occupancy", "person/m2", {[](P& p) { return &p.person_m2; }}, {0.3, 1.0, 1.8},
                "People/*/people_per_floor_area"),
      scaled<P>("outdoor_air", "m3/s per person", {[](P& p) { return &p.outdoor_m3_s_person; }},
                {0.4, 1.0, 1.6}, "DesignSpecification:OutdoorAir/*/outdoor_air_flow_per_person"),
      scaled<P>("lighting", "W/m2", {[](P& p) { return &p.lighting_W_m2; }}, {0.75, 1.0, 1.25},
                "Lights/*/watts_per_floor_area"),
      scaled<P>("equipment", "W/m2", {[](P& p) { return &p.equipment_W_m2; }}, {0.75, 1.0, 1.25},
                "ElectricEquipment/*/watts_per_floor_area")};
  for (const auto& quantity : shared_quantities<P>()) quantities.push_back(quantity);
  return quantities;
}

/// Each quantity has a stream of its own, so that a new one leaves the others as they were.
template <class Parameters>
HiddenTruth<Parameters> draw(const std::vector<Quantity<Parameters>>& quantities,
                             std::uint64_t seed) {
  HiddenTruth<Parameters> truth;
  for (std::size_t i = 0; i < quantities.size(); ++i) {
    const Quantity<Parameters>& quantity = quantities[i];
    Rng rng = stream_of(seed, Stream::building, 1000 + i);
    const double change = quantity.change.draw(rng);
    double* first = quantity.of.front()(truth.parameters);
    const double drawn = *first;
    for (const auto& of : quantity.of) {
      double& value = *of(truth.parameters);
      value = quantity.by == By::factor ? value * change : value + change;
    }
    truth.description["parameters"][quantity.name] = {
        {"unit", quantity.unit}, {"drawings", drawn},
        {"truth", *first},       {"change", quantity.by == By::factor ? "scale" : "add"},
        {"by", change},          {"targets", quantity.targets}};
  }
  truth.description["seed"] = seed;
  return truth;
}

}  // namespace

HiddenTruth<LaboratoryParameters> laboratory_truth(std::uint64_t seed) {
  return draw(laboratory_quantities(), seed);
}

HiddenTruth<SmallOfficeParameters> small_office_truth(std::uint64_t seed) {
  return draw(small_office_quantities(), seed);
}

}  // namespace recald::simulators::energyplus
