/// The hourly model: zones of five resistances and one capacity, air handlers and plant, step by
/// step.
///
/// Each zone of `describe_zones`, with its core split below the top storey, is a network after ISO
/// 13790:2008 annex C. A building whose handlers run partly round the clock has each zone twice:
/// served by day, and served always. The air system follows EN 15241:2007 as in the EPC. Power is
/// summed to meters at the end.
#pragma once

#include <Eigen/Core>
#include <array>
#include <memory>
#include <span>
#include <vector>

#include "core/model/building.hpp"
#include "core/model/drivers.hpp"
#include "core/model/end_use.hpp"
#include "core/model/hourly/alteration.hpp"
#include "core/model/hourly/plant.hpp"
#include "core/model/hourly/zone_networks.hpp"

namespace recald::model::hourly {

struct HourlyOptions {
  int steps_per_hour = 1;  ///< 1 or 4.
};

/// Evaluates buildings over one period. Holds scratch memory: use one instance per thread.
class Hourly {
 public:
  /// @pre options.steps_per_hour is 1 or 4
  explicit Hourly(std::shared_ptr<const Drivers> drivers, const HourlyOptions& options = {});

  /// Runs the whole period after a warm-up of its first 14 days; after a jump in time, the days
  /// behind the jump are warmed up likewise.
  ///
  /// @param alterations  Applied in order; empty: the building as described.
  /// @param meters       (m) share of each end use that a meter counts.
  /// @param power_kW     (steps x m) mean power of each step, overwritten. Does not allocate.
  void run(const Building& building, std::span<const Alteration* const> alterations,
           std::span<const MeterMap> meters, Eigen::Ref<Eigen::ArrayXXd> power_kW);

  /// As above, with energies by end use.
  /// @param months  (months of the drivers) overwritten.
  void run_end_uses(const Building& building, std::span<const Alteration* const> alterations,
                    std::span<EndUseEnergy> months);

  [[nodiscard]] const Drivers& drivers() const { return *drivers_; }
  [[nodiscard]] Eigen::Index step_count() const;

 private:
  /// The drivers of an hour, in few bytes.
  struct Hour {
    double dry_bulb_C;
    double humidity_ratio;
    double wind_m_s;
    double wet_bulb_C;
    double occupied_fraction;
    double lights_W;
    double plugs_W;
    float dark_share;
    float hours_to_start;  ///< These four as in the drivers.
    float hours_since_stop;
    float hours_since_start;
    float hours_to_stop;
    int day_of_year;
    bool occupied;
    bool heating;  ///< The plant is on.
    bool cooling;
    bool sunlit;  ///< Any sun on any side.
    bool begins;  ///< First hour, or first after a jump in time.
  };
  /// A part of the building: its share, and whether its rooms are served round the clock.
  struct Part {
    double share;
    bool always;
  };

  void read_meters(std::span<const MeterMap> meters);
  /// @param hour  As the building is then.
  void prepare(const Building& building, std::span<const Alteration* const> alterations,
               std::size_t hour);
  /// The first hour after `from` at which something begins or ends to be rebuilt; else `to`.
  [[nodiscard]] std::size_t rebuilt_until(std::size_t from, std::size_t to,
                                          std::span<const Alteration* const> alterations) const;
  [[nodiscard]] StepOperation operation_of(std::size_t hour, int step) const;
  /// Progress of the start of a day; all 1 later in the day and at night.
  struct Morning {
    double climbed = 1.0;  ///< Of the heating set-point, from its night value.
    double open = 1.0;     ///< Share of the hour's running part with outdoor-air dampers open.
  };
  [[nodiscard]] Morning morning_of(const Hour& hour) const;
  void follow_timetable(const Hour& hour, StepOperation& operation) const;
  static void switch_off(const Hour& hour, StepOperation& operation);
  static void switch_off(const Hour& hour, StepLoads& loads);
  [[nodiscard]] ZoneTotals solve_zones(std::size_t hour, const StepOperation& operation,
                                       const Morning& morning, double served_share);
  void serve_closets(double heat_W, const StepOperation& operation, ZoneTotals& totals) const;
  [[nodiscard]] StepLoads solve_step(std::size_t hour, int step,
                                     std::span<const Alteration* const> alterations);
  template <class Sink>
  void run_hours(std::size_t from, std::size_t to, std::span<const Alteration* const> alterations,
                 Sink sink);
  template <class Sink>
  void simulate(const Building& building, std::span<const Alteration* const> alterations,
                Sink sink);

  std::shared_ptr<const Drivers> drivers_;
  HourlyOptions options_;
  double heat_capacity_J_m3K_;  ///< ρ c_p of outdoor air at the site.
  std::vector<Hour> hours_;
  std::vector<double> irradiance_W_m2_;  ///< [hour * orientations + orientation]

  // Of the current run.
  Building building_;
  ZoneNetworks zones_;
  Plant plant_;
  std::vector<EndUsePower_W> meters_kW_W_;  ///< (m) by EndUse: kW counted per W.
  LeakageFlow leakage_{};
  StepOperation standing_{};  ///< The part that does not change from step to step.
  std::array<Part, 2> parts_{};
  int part_count_ = 1;
  double mean_people_share_ = 0.0;  ///< Of full occupancy, over a week.
  double middle_C_ = 0.0;           ///< Between the occupied set-points, for infiltration.
  double most_flow_m3_s_ = 0.0;
  double hot_water_W_ = 0.0;  ///< Of the current day.
  int hot_water_day_ = 0;     ///< Its day of the year.
};

}  // namespace recald::model::hourly
