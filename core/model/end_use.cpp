#include "core/model/end_use.hpp"

#include <algorithm>
#include <initializer_list>
#include <string>

namespace recald::model {
namespace {

MeterMap map_of(std::initializer_list<EndUse> uses) {
  MeterMap map;
  for (const EndUse use : uses) map[use] = 1.0;
  return map;
}

}  // namespace

double MeterMap::sum_kWh(const EndUseEnergy& energy) const {
  double total_kWh = 0.0;
  for (std::size_t i = 0; i < kEndUses; ++i) {
    total_kWh += shares_[i] * energy[static_cast<EndUse>(i)];
  }
  return total_kWh;
}

Result<MeterMap> default_meter_map(metering::Utility utility) {
  using enum EndUse;
  switch (utility) {
    case metering::Utility::electricity:
      return map_of({lighting, plugs, exterior, fans, pumps, chiller});
    case metering::Utility::chilled_water:
      return map_of({sensible_cooling, latent_cooling});
    case metering::Utility::heating:
    case metering::Utility::steam:
    case metering::Utility::gas:
      return map_of({zone_heating, reheat, preheat, humidification, hot_water, base_heat});
    case metering::Utility::water:
      break;
  }
  return failure(
      ErrorCode::unsupported,
      "no end use of the building models is on a water meter; remove it from the model's outputs");
}

Result<EndUse> parse_end_use(std::string_view name) {
  const auto found = std::ranges::find(kEndUseNames, name);
  if (found != kEndUseNames.end()) return static_cast<EndUse>(found - kEndUseNames.begin());
  std::string known;
  for (const std::string_view candidate : kEndUseNames) {
    known += known.empty() ? "" : ", ";
    known += candidate;
  }
  return failure(ErrorCode::not_found,
                 "unknown end use '" + std::string{name} + "'; known are " + known);
}

}  // namespace recald::model
