/// A building in operation: people, loads, envelope, air handlers, plant, and its hidden effects.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "simulators/building/air_handler.hpp"
#include "simulators/building/calendar.hpp"
#include "simulators/building/envelope.hpp"
#include "simulators/building/hidden_effect.hpp"
#include "simulators/building/internal_loads.hpp"
#include "simulators/building/people.hpp"
#include "simulators/building/plant.hpp"

namespace recald::simulators {

using HiddenEffects = std::vector<std::unique_ptr<HiddenEffect>>;

class Building {
 public:
  /// @param effects  Applied in this order; may be empty.
  Building(Truth truth, std::chrono::seconds step, std::uint64_t seed, HiddenEffects effects);

  /// Advances one step under this weather. @pre local days come in order
  UtilityPower advance(const Outdoors& outdoors, metering::Instant instant,
                       const metering::LocalTime& local);

  // For tests and inspection.
  [[nodiscard]] const Truth& truth() const { return truth_; }
  [[nodiscard]] std::chrono::seconds step() const {
    return std::chrono::seconds{static_cast<std::int64_t>(step_s_)};
  }
  [[nodiscard]] const HiddenEffects& effects() const { return effects_; }
  [[nodiscard]] const std::vector<Zone>& zones() const { return envelope_.zones(); }
  [[nodiscard]] const ServiceLoad& load() const { return load_; }
  /// Heat that a zone received in the last step from outside, neighbours, gains and supply air,
  /// minus what its air and constructions stored; 0 except for rounding.
  [[nodiscard]] double heat_imbalance_J(std::size_t zone) const { return zone_imbalance_J_[zone]; }
  /// As above for all zones together: heat between rooms must cancel.
  [[nodiscard]] double heat_imbalance_J() const { return heat_imbalance_J_; }

 private:
  void begin_day(metering::Day day);
  [[nodiscard]] Moment moment(const Outdoors& outdoors, metering::Instant instant,
                              const metering::LocalTime& local) const;
  [[nodiscard]] Operation as_built() const;
  [[nodiscard]] bool runs_by_timetable(double hour) const;
  [[nodiscard]] AirHandlerCommand command_scheduled(std::size_t air_handler, const Moment& now,
                                                    const Operation& operation);
  [[nodiscard]] AirHandlerCommand command_at_night(std::size_t air_handler, const Moment& now,
                                                   const Operation& operation);
  [[nodiscard]] AirHandlerCommand command_always(const Moment& now,
                                                 const Operation& operation) const;
  void run_air_handlers(const Moment& now, const Operation& operation);
  void run_air_handler(std::size_t index, const Moment& now, const Operation& operation);
  void add_gains(const Moment& now, const Operation& operation);
  void exchange_through_doors();
  void advance_zones();

  Truth truth_;
  double step_s_;
  Calendar calendar_;
  Envelope envelope_;
  People people_;
  InternalLoads internal_loads_;
  Plant plant_;
  HiddenEffects effects_;
  std::vector<AirHandler>
      air_handlers_;                 ///< The perimeter's at 2·storey, the core's at 2·storey + 1.
  std::vector<bool> night_cycle_;    ///< By air handler.
  std::vector<double> pressurised_;  ///< By storey, 0…1.
  std::vector<ZoneLoads> zone_loads_;
  std::vector<AirHandlerWork> work_;
  std::vector<double> zone_imbalance_J_;
  std::optional<metering::Day> today_;
  Timetable timetable_{};
  DayKind day_kind_ = DayKind::workday;  ///< From the calendar.
  ServiceLoad load_;
  double heat_imbalance_J_ = 0.0;
};

}  // namespace recald::simulators
