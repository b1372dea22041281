#include "tests/blind/energyplus/foreign_building.hpp"

#include <fmt/format.h>

#include <array>
#include <cstdlib>
#include <fstream>

#include "simulators/chance/chance.hpp"
#include "simulators/energyplus/model_edits.hpp"

namespace recald::blind {
namespace {

using simulators::Triangular;
using simulators::Use;
using simulators::energyplus::scale;

constexpr std::array kModels{
    ForeignModel{"ASHRAE901_OfficeMedium_STD2019_Denver.epJSON", Use::office},
    ForeignModel{"LrgOff_GridStorageScheduled.epJSON", Use::office},
    ForeignModel{"ShopWithPVandBattery.epJSON", Use::shop},
    ForeignModel{"radiant_residential_building.epJSON", Use::hotel},
    ForeignModel{"2ZoneDataCenterHVAC_wEconomizer_CW.epJSON", Use::hotel},
    ForeignModel{"1ZoneDataCenterCRAC_wApproachTemp.epJSON", Use::hotel}};

/// Whether a field is a place on the ground.
bool is_horizontal(std::string_view field) {
  for (const std::string_view part : {"x_coordinate", "y_coordinate", "x_origin", "y_origin"}) {
    if (field.find(part) != std::string_view::npos) return true;
  }
  return false;
}

void stretch(Json& part, double factor) {
  if (part.is_array()) {
    for (Json& each : part) stretch(each, factor);
    return;
  }
  if (!part.is_object()) return;
  for (auto& [field, value] : part.items()) {
    if (value.is_number() && is_horizontal(field)) {
      value = factor * value.get<double>();
    } else {
      stretch(value, factor);
    }
  }
}

/// What is given for a whole room grows with its floor.
void scale_totals(Json& model, double factor) {
  scale(model, "People", {"number_of_people"}, factor);
  scale(model, "Lights", {"lighting_level"}, factor);
  scale(model, "ElectricEquipment", {"design_level", "watts_per_unit"}, factor);
  scale(model, "GasEquipment", {"design_level"}, factor);
  scale(model, "Exterior:", {"design_level"}, factor);
  scale(model, "ZoneInfiltration:", {"design_flow_rate"}, factor);
  scale(model, "DesignSpecification:OutdoorAir", {"outdoor_air_flow_per_zone"}, factor);
  scale(model, "Fan:ZoneExhaust", {"maximum_flow_rate"}, factor);
  scale(model, "WaterUse:Equipment", {"peak_flow_rate"}, factor);
}

}  // namespace

std::span<const ForeignModel> foreign_models() { return kModels; }

Result<Json> read_foreign_model(std::string_view file) {
  const char* const folder = std::getenv("RECALD_EXAMPLES");
  if (folder == nullptr) {
    return failure(ErrorCode::not_found,
                   "RECALD_EXAMPLES names no folder; this population has models of others, which "
                   "the package sinergym holds");
  }
  std::ifstream stream(std::filesystem::path{folder} / file);
  Json model = Json::parse(stream, nullptr, false);
  if (model.is_discarded()) {
    return failure(ErrorCode::io_failed, fmt::format("cannot read {} in {}", file, folder));
  }
  model["Version"].front()["version_identifier"] = simulators::energyplus::kVersion;
  return model;
}

Json altered(Json model, Rng rng) {
  const auto draw = [&](double min, double mode, double max) {
    return Triangular{min, mode, max}.draw(rng);
  };
  const double length = draw(0.85, 1.0, 1.2);
  stretch(model, length);
  scale_totals(model, length * length);
  const double resistance = draw(0.6, 1.0, 1.6);
  scale(model, "Material:NoMass", {"thermal_resistance"}, resistance);
  simulators::energyplus::scale_solar_gain(model, draw(0.8, 1.0, 1.2));
  simulators::energyplus::scale_lights(model, draw(0.7, 1.0, 1.4));
  simulators::energyplus::scale_equipment(model, draw(0.7, 1.0, 1.4));
  simulators::energyplus::scale_people(model, draw(0.7, 1.0, 1.4));
  simulators::energyplus::scale_infiltration(model, draw(0.6, 1.0, 1.8));
  return model;
}

}  // namespace recald::blind
