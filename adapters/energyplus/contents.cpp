#include "adapters/energyplus/contents.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <fstream>
#include <map>
#include <tuple>

#include "adapters/energyplus/model/fields.hpp"
#include "adapters/sqlite/tables/database.hpp"
#include "core/text/ascii.hpp"

namespace recald::energyplus {
namespace {

constexpr double kJoule_kWh = 1.0 / 3.6e6;

/// What meters count, in EnergyPlus's words.
// clang-format off
constexpr std::string_view kResources[] = {
    "Electricity", "NaturalGas", "Gasoline", "Diesel", "Coal", "FuelOilNo1", "FuelOilNo2",
    "Propane", "OtherFuel1", "OtherFuel2", "DistrictCooling", "DistrictHeatingWater",
    "DistrictHeatingSteam", "EnergyTransfer", "PlantLoopHeatingDemand", "PlantLoopCoolingDemand",
    "ElectricityPurchased", "ElectricitySurplusSold", "ElectricityNet", "ElectricityProduced",
    "SolarWater", "SolarAir",
};
// clang-format on

/// Types of objects whose numbers describe the building's substance, use and plant. A prefix each.
// clang-format off
constexpr std::string_view kWorthVarying[] = {
    "Material", "WindowMaterial:", "Construction:", "People", "Lights", "ElectricEquipment",
    "GasEquipment", "HotWaterEquipment", "SteamEquipment", "OtherEquipment", "Exterior:",
    "ZoneInfiltration:", "ZoneVentilation:", "ZoneMixing", "AirflowNetwork:MultiZone:Surface",
    "DesignSpecification:OutdoorAir", "Controller:OutdoorAir", "SetpointManager:", "Fan:",
    "Pump:", "Coil:", "CoilPerformance:", "Boiler:", "Chiller:", "CoolingTower:",
    "DistrictHeating", "DistrictCooling", "AirTerminal:", "HeatExchanger:", "AirConditioner:",
    "HeatPump:", "WaterHeater:", "WaterUse:Equipment", "ZoneHVAC:", "EvaporativeCooler:",
    "Humidifier:", "Dehumidifier:", "Refrigeration:", "Generator:", "ElectricLoadCenter:",
    "Daylighting:Controls", "Site:GroundTemperature:", "Site:GroundReflectance",
    "Site:WaterMainsTemperature", "SurfaceProperty:", "WindowProperty:", "InternalMass",
};
// clang-format on

/// Among those, what joins things together.
// clang-format off
constexpr std::string_view kNotWorthVarying[] = {
    "ZoneHVAC:EquipmentConnections", "ZoneHVAC:EquipmentList", "ZoneHVAC:AirDistributionUnit",
    "WindowProperty:FrameAndDivider", "ElectricLoadCenter:Distribution",
};
// clang-format on

/// Fields that place or number things.
// clang-format off
constexpr std::string_view kNotQuantities[] = {
    "_coordinate", "sequence", "number_of_speeds", "coefficient_", "convergence", "idf_",
};
// clang-format on

bool is_resource(std::string_view part) {
  return std::ranges::find(kResources, part) != std::end(kResources);
}

/// "GeneralLights:InteriorLights:Electricity:Zone:CORE": a part of an end use, the end use, the
/// resource, the part of the building. All but the resource may be absent.
ReportedMeter meter_of(const std::string& name) {
  ReportedMeter meter{name, {}, {}, {}, {}};
  std::size_t begin = 0;
  while (begin <= name.size()) {
    const std::size_t end = std::min(name.find(':', begin), name.size());
    const std::string part = name.substr(begin, end - begin);
    if (is_resource(part)) {
      meter.resource = part;
      if (begin > 0) meter.end_use = name.substr(0, begin - 1);
      if (end < name.size()) meter.where = name.substr(end + 1);
      return meter;
    }
    begin = end + 1;
  }
  meter.end_use = name;  // a meter of the user's own
  return meter;
}

/// The whole building, end uses, their parts, HVAC and the like, zones and kinds of space.
int rank_of(const ReportedMeter& meter) {
  if (meter.where == "Facility") return 0;
  if (meter.where.empty()) return meter.end_use.find(':') == std::string::npos ? 1 : 2;
  return meter.where.find(':') == std::string::npos ? 3 : 4;
}

/// A line of eplusout.mdd: "Zone,Meter,Electricity:Facility [J]", or as an object of IDF,
/// "Output:Meter,Electricity:Facility,hourly; !- [J]". Empty for any other.
std::string name_in(std::string_view line) {
  if (line.find("[J]") == std::string_view::npos) return {};
  for (const std::string_view before : {"Zone,Meter,", "HVAC,Meter,", "Output:Meter,"}) {
    if (!line.starts_with(before)) continue;
    line.remove_prefix(before.size());
    const std::size_t end = std::min(line.find(" ["), line.find(','));
    return std::string{line.substr(0, end)};
  }
  return {};
}

/// Of meters in joules. Where one is reported at several intervals the sums are the same.
Result<std::map<std::string, double>> totals_in(const std::filesystem::path& file) {
  auto database =
      TRY(sqlite::Database::open(file, {.access = sqlite::Database::Access::read_only, .vfs = {}}));
  auto statement = TRY(database.prepare(
      "SELECT m.Name, sum(d.Value) FROM ReportDataDictionary m "
      "JOIN ReportData d ON d.ReportDataDictionaryIndex = m.ReportDataDictionaryIndex "
      "JOIN Time t ON t.TimeIndex = d.TimeIndex "
      "JOIN EnvironmentPeriods e ON e.EnvironmentPeriodIndex = t.EnvironmentPeriodIndex "
      "WHERE m.IsMeter = 1 AND m.Units = 'J' AND e.EnvironmentType = 3 "
      "AND coalesce(t.WarmupFlag, 0) = 0 GROUP BY m.ReportDataDictionaryIndex"));
  std::map<std::string, double> totals;
  for (;;) {
    const auto has_row = TRY(statement.step());
    if (!has_row) return totals;
    totals[statement.text(0)] = statement.real(1) * kJoule_kWh;
  }
}

bool starts_with_any(std::string_view text, std::span<const std::string_view> prefixes) {
  return std::ranges::any_of(prefixes, [&](std::string_view p) { return text.starts_with(p); });
}

bool is_quantity(std::string_view field) {
  return std::ranges::none_of(kNotQuantities, [&](std::string_view word) {
    return field.find(word) != std::string_view::npos;
  });
}

std::string quoted_name(std::string_view pattern) {
  std::string name{pattern};
  const std::size_t slash = name.find('/');
  name = name.substr(0, slash) + "_" + name.substr(name.rfind('/') + 1);
  for (char& c : name) c = c == ':' ? '_' : to_lower(c);
  return name;
}

}  // namespace

void ask_for_meters(Json& objects) {
  objects["Output:VariableDictionary"] = {{"recald", {{"key_field", "regular"}}}};
  for (auto& [name, files] : objects["OutputControl:Files"].items()) files["output_mdd"] = "Yes";
}

Result<std::vector<ReportedMeter>> what_is_reported(const std::filesystem::path& folder) {
  std::map<std::string, double> totals;
  if (std::filesystem::exists(folder / "eplusout.sql")) {
    totals = TRY(totals_in(folder / "eplusout.sql"));
  }
  std::vector<ReportedMeter> meters;
  std::ifstream dictionary{folder / "eplusout.mdd"};
  for (std::string line; std::getline(dictionary, line);) {
    if (const std::string name = name_in(line); !name.empty()) meters.push_back(meter_of(name));
  }
  if (meters.empty()) {
    for (const auto& [name, total] : totals) meters.push_back(meter_of(name));
  }
  if (meters.empty()) {
    return failure(ErrorCode::not_found,
                   fmt::format("{} does not say which meters the model has: the run was not asked, "
                               "or it failed",
                               folder.string()));
  }
  for (ReportedMeter& meter : meters) {
    if (const auto total = totals.find(meter.name); total != totals.end()) {
      meter.total_kWh = total->second;
    }
  }
  std::ranges::stable_sort(meters, {}, [](const ReportedMeter& m) {
    return std::tuple{rank_of(m), m.resource, m.where, -m.total_kWh.value_or(0.0), m.end_use};
  });
  const auto twice = std::ranges::unique(meters, {}, &ReportedMeter::name);
  meters.erase(twice.begin(), twice.end());
  return meters;
}

std::vector<VariableField> what_could_be_varied(const ModelDocument& model) {
  std::vector<VariableField> fields;
  for (const auto& [type, named] : model.objects.items()) {
    if (!starts_with_any(type, kWorthVarying) || starts_with_any(type, kNotWorthVarying)) continue;
    std::map<std::string, std::size_t> known;  // the place of a field among `fields`
    for (const auto& [name, object] : objects_of(model.objects, type)) {
      for (const auto& [key, value] : object->items()) {
        if (!value.is_number() || !is_quantity(key)) continue;
        const double number = value.get<double>();
        const auto [place, is_new] = known.try_emplace(key, fields.size());
        if (is_new) {
          fields.push_back({fmt::format("{}/*/{}", type, key), 1, number, number});
          continue;
        }
        VariableField& field = fields[place->second];
        ++field.objects;
        field.smallest = std::min(field.smallest, number);
        field.largest = std::max(field.largest, number);
      }
    }
  }
  return fields;
}

std::string paste_lines(const KnownParameter& parameter) {
  const Prior& prior = parameter.parameter.prior;
  return fmt::format("[[model.parameter]]\nname = \"{}\"\nprior = [{:.4g}, {:.4g}, {:.4g}]{}\n",
                     parameter.parameter.name, prior.min(), prior.mode(), prior.max(),
                     parameter.parameter.unit == "-" ? "" : "  # " + parameter.parameter.unit);
}

std::string paste_lines(const VariableField& field) {
  return fmt::format(
      "[[model.parameter]]\nname = \"{}\"\ntargets = [\"{}\"]\nchange = \"scale\"\n"
      "prior = [0.9, 1.0, 1.1]\n",
      quoted_name(field.pattern), field.pattern);
}

}  // namespace recald::energyplus
