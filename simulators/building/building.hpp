/// The campus laboratory building at work: people, loads, envelope, air handlers, services.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "simulators/building/air_handler.hpp"
#include "simulators/building/campus_calendar.hpp"
#include "simulators/building/district_service.hpp"
#include "simulators/building/envelope.hpp"
#include "simulators/building/internal_loads.hpp"
#include "simulators/building/people.hpp"

namespace recald::simulators {

class Building {
 public:
  Building(const Truth& truth, std::uint64_t seed);

  /// One step of `kStep` under this weather. @pre local days come in order
  UtilityPower advance(const Outdoors& outdoors, const metering::LocalTime& local);

  // For tests and for people who want to look inside.
  [[nodiscard]] const std::vector<Zone>& zones() const { return envelope_.zones(); }
  [[nodiscard]] const AirHandlerWork& air_handler_work(std::size_t i) const { return work_[i]; }
  [[nodiscard]] const ServiceLoad& load() const { return load_; }
  [[nodiscard]] int people_present() const { return people_present_; }
  /// Heat that entered the building from outside, gains and supply air in the last step, minus what
  /// rooms and walls stored of it; 0 but for rounding. Heat between rooms must cancel.
  [[nodiscard]] double heat_imbalance_J() const { return heat_imbalance_J_; }

 private:
  struct Clock {
    DayKind kind;
    int minute_of_day;
    double hour;
  };
  void begin_day(metering::Day day);
  [[nodiscard]] AirHandlerCommand command_office(std::size_t storey, const Clock& clock);
  [[nodiscard]] AirHandlerCommand command_laboratory(const Clock& clock) const;
  void run_air_handlers(const Outdoors& outdoors, const Clock& clock);
  void add_gains(const Clock& clock, const Outdoors& outdoors);
  void exchange_through_doors();
  void advance_zones();

  Truth truth_;
  Envelope envelope_;
  People people_;
  InternalLoads internal_loads_;
  DistrictService services_;
  std::vector<AirHandler> air_handlers_;  ///< Offices at 2·storey, laboratories at 2·storey + 1.
  std::array<bool, drawings::storeys> night_cycle_{};
  std::array<bool, drawings::storeys> pressurised_{};
  std::array<ZoneLoads, drawings::zones> zone_loads_{};
  std::array<AirHandlerWork, drawings::air_handlers> work_{};
  std::optional<metering::Day> today_;
  DayKind today_kind_ = DayKind::workday;
  ServiceLoad load_;
  int people_present_ = 0;
  double heat_imbalance_J_ = 0.0;
};

}  // namespace recald::simulators
