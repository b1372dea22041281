/// An effect in a building that its drawings do not show.
#pragma once

#include <span>

#include "simulators/building/operation.hpp"
#include "simulators/building/plant.hpp"
#include "simulators/building/truth.hpp"

namespace recald::simulators {

inline constexpr std::chrono::seconds kInterval{900};  ///< Of every meter.

/// What one meter measured over the whole record, before it is sent anywhere.
struct MeterRecord {
  Utility utility;
  metering::Instant begin;
  const metering::LocalCalendar& calendar;
  std::span<double> shown_kW;  ///< One per `kInterval`, without gaps.
};

/// The building calls a hook at each place that an effect can change; most effects use one. Every
/// hook must change nothing at strength 0, and before its first date. An effect may keep state from
/// step to step (the charge of a store), and draws random numbers only from its own stream.
class HiddenEffect {
 public:
  virtual ~HiddenEffect() = default;
  /// Once, before the building is created: what was built or set differently from the drawings.
  virtual void build(Truth& /*truth*/) const {}
  /// Each local day at midnight, before people plan their day.
  virtual void plan(metering::Day /*day*/, Timetable& /*timetable*/) {}
  /// Each step, before controls act.
  virtual void operate(const Moment& /*now*/, Operation& /*operation*/) {}
  /// Each step, once coils and rooms have computed their demand.
  virtual void load(const Moment& /*now*/, ServiceLoad& /*load*/) {}
  /// Each step, on the power that passes the meters.
  virtual void supply(const Moment& /*now*/, UtilityPower& /*power*/) {}
  /// Once for each meter, at the end.
  virtual void distort(const MeterRecord& /*record*/) const {}
};

}  // namespace recald::simulators
