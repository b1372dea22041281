/// The EPC model: a monthly quasi-steady energy balance of a building with a VAV air system, or
/// with units in its rooms (whose fans run by schedule only, not on call at night).
///
/// Heating and cooling need of each zone follow from the utilisation of gains and losses (ISO
/// 13790:2008). They are spread over classes of similar hours for the air side, where flow limits,
/// reheat, outdoor air and dehumidification are not linear. Differences from the plain monthly
/// method, each with its reason:
/// - perimeter and core are separate zones if boxes can heat one and cool the other
///   (see zones.hpp);
/// - rooms whose air runs round the clock keep their set-points; the others drift when unoccupied;
/// - set-back by the mean of a first-order drift, so that a set-back can be calibrated;
/// - the air system uses the dead band between the set-points before it reheats;
/// - all sums over hours are taken before averaging (see climate_classes.hpp).
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "core/model/building.hpp"
#include "core/model/end_use.hpp"
#include "core/model/epc/climate_classes.hpp"
#include "core/model/zones.hpp"

namespace recald::model::epc {

/// Compared with the plain hourly sum of a building with five zones, the error is at most 0.4
/// % of a mean month's cooling and 2.2 % of a month's heating (0.8 % of a year's), at a
/// fifteenth of the cost.
inline constexpr int kClassesPerState = 24;

/// Evaluates buildings over one period. Holds scratch memory: use one instance per thread.
class Epc {
 public:
  explicit Epc(std::shared_ptr<const ClimateClasses> climate);

  /// @param building  Its surfaces face only orientations of the drivers.
  /// @param months    (months of the period) metered energies, overwritten. Does not allocate.
  void evaluate(const Building& building, std::span<EndUseEnergy> months);

  [[nodiscard]] std::size_t month_count() const { return climate_->months.size(); }

 private:
  /// Heat flows of one zone in one class of hours.
  struct ClassBalance {
    double gains_W;
    double conductance_W_K;  ///< Zone to outdoors: transmission, infiltration, ventilation.
    double
        cooling_balance_W;  ///< To remove at the cooling set-point; negative: the zone lacks heat.
    double heating_balance_W;  ///< To supply at the heating set-point; negative: gains suffice.
    double running_cooling_W;  ///< As above, in rooms that keep their daytime set-points.
    double running_heating_W;
  };
  /// Temperatures that the controls maintain in a state of a month, mean over the zone.
  struct HeldTemperatures {
    double cooling_C;
    double heating_C;
  };
  /// When a zone's monthly cooling need occurs: each class takes its own load times
  /// `scale`, plus `extra_W`.
  struct CoolingSpread {
    double scale;
    double extra_W;
  };
  /// Total demand of all boxes on the air handlers in one class of hours.
  struct AirDemand {
    double supply_m3_s;
    double return_C;
    double reheat_W;
  };
  struct MonthlySums;
  struct AirTotals;

  [[nodiscard]] ClassBalance* balances(std::size_t zone) {
    return balance_.data() + zone * climate_->classes.size();
  }
  void find_leakage_per_area(const Building& building);
  /// @param fan_W  Heat that fans of units in rooms give to them.
  void fill_gains(const Building& building, const Zone& zone, const ClimateState& state,
                  double fan_W, ClassBalance* balance) const;
  [[nodiscard]] HeldTemperatures unoccupied_temperatures(const Building& building, const Zone& zone,
                                                         const ClimateMonth& month,
                                                         const ClassBalance* balance) const;
  void balance_state(const Building& building, const Zone& zone, const ClimateState& state,
                     const HeldTemperatures& held, double ventilation_m3_s,
                     ClassBalance* balance) const;
  [[nodiscard]] MonthlySums sum_month(const ClimateMonth& month, const ClassBalance* balance) const;
  void evaluate_zone(const Building& building, std::size_t zone, const ClimateMonth& month,
                     EndUseEnergy& energy);
  void evaluate_month(const Building& building, const ClimateMonth& month, EndUseEnergy& energy);
  [[nodiscard]] CoolingSpread spread_cooling(const Building& building, const ClimateMonth& month,
                                             const ClassBalance* balance,
                                             double cooling_need_kWh) const;
  void add_air_side(const Building& building, const ClimateMonth& month, EndUseEnergy& energy);
  void add_room_units(const Building& building, const ClimateMonth& month,
                      EndUseEnergy& energy) const;
  [[nodiscard]] double moisture_Wh(const Building& building, const ClimateState& state,
                                   double running_share, double coil_W) const;
  [[nodiscard]] double free_cooling_share(const Building& building, const Zone& zone,
                                          const ClimateMonth& month,
                                          const ClassBalance* balance) const;
  [[nodiscard]] AirDemand boxes_of_class(const Building& building, int class_index);
  void add_air_state(const Building& building, const ClimateState& state, double running_share,
                     AirTotals& totals);

  std::shared_ptr<const ClimateClasses> climate_;
  double heat_capacity_J_m3K_;  ///< ρ c_p of outdoor air at the site.
  double coil_humidity_ratio_ = 0.0;
  std::vector<Zone> zones_;
  std::vector<CoolingSpread> spreads_;        ///< By zone, for the current month.
  std::vector<ClassBalance> balance_;         ///< [zone * classes + class]
  std::vector<double> leakage_m3_s_per_cm2_;  ///< By class.
};

}  // namespace recald::model::epc
