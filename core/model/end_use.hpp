/// The end uses of a building's energy, and how meters sum them.
#pragma once

#include <array>
#include <cstddef>
#include <string_view>

#include "core/metering/reading.hpp"
#include "core/result.hpp"

namespace recald::model {

/// Metered energy by purpose; losses and efficiencies between the meter and the use are included.
enum class EndUse : std::size_t {
  lighting,
  plugs,
  exterior,
  fans,
  pumps,
  chiller,           ///< Electricity of the building's own chiller.
  sensible_cooling,  ///< Chilled water: coil, sensible part (zone, reheat, outdoor air, fan heat).
  latent_cooling,    ///< Chilled water: coil, dehumidification.
  zone_heating,
  reheat,
  preheat,
  humidification,
  hot_water,
  base_heat,
};
inline constexpr std::size_t kEndUses = 14;

inline constexpr std::array<std::string_view, kEndUses> kEndUseNames = {
    "lighting",         "plugs",          "exterior",     "fans",   "pumps",   "chiller",
    "sensible_cooling", "latent_cooling", "zone_heating", "reheat", "preheat", "humidification",
    "hot_water",        "base_heat"};

/// Energies of one month, kWh, indexed by EndUse.
class EndUseEnergy {
 public:
  double& operator[](EndUse use) { return kWh_[static_cast<std::size_t>(use)]; }
  double operator[](EndUse use) const { return kWh_[static_cast<std::size_t>(use)]; }

 private:
  std::array<double, kEndUses> kWh_{};
};

/// Share of each end use that a meter counts, usually 0 or 1.
class MeterMap {
 public:
  double& operator[](EndUse use) { return shares_[static_cast<std::size_t>(use)]; }
  double operator[](EndUse use) const { return shares_[static_cast<std::size_t>(use)]; }
  [[nodiscard]] double sum_kWh(const EndUseEnergy& energy) const;
  bool operator==(const MeterMap&) const = default;

 private:
  std::array<double, kEndUses> shares_{};
};

/// What a main meter of this utility counts in such a building by default. Fails with unsupported
/// for a utility that no end use draws on (water).
[[nodiscard]] Result<MeterMap> default_meter_map(metering::Utility utility);

/// Fails with not_found and the list of names.
[[nodiscard]] Result<EndUse> parse_end_use(std::string_view name);

}  // namespace recald::model
