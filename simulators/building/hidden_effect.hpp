/// Something in a building that its drawings do not show.
#pragma once

#include <span>

#include "simulators/building/operation.hpp"
#include "simulators/building/plant.hpp"
#include "simulators/building/truth.hpp"

namespace recald::simulators {

inline constexpr std::chrono::seconds kInterval{900};  ///< Of every meter.

/// What one meter has shown over the whole record, before it is sent anywhere.
struct MeterRecord {
  Utility utility;
  metering::Instant begin;
  const metering::LocalCalendar& calendar;
  std::span<double> shown_kW;  ///< One an interval of `kInterval`, gapless.
};

/// The building asks at each place where something can be otherwise; a plain effect answers at one.
/// Every hook must leave things as they are at strength 0, and before its first date. It may keep
/// state from step to step (a store's charge), and draws chance from a stream of its own only.
class HiddenEffect {
 public:
  virtual ~HiddenEffect() = default;
  /// Once, before the building stands: what was built or set otherwise than drawn.
  virtual void build(Truth& /*truth*/) const {}
  /// Each local day at midnight, before people plan theirs.
  virtual void plan(metering::Day /*day*/, Timetable& /*timetable*/) {}
  /// Each step, before controls act.
  virtual void operate(const Moment& /*now*/, Operation& /*operation*/) {}
  /// Each step, when coils and rooms have said what they need.
  virtual void load(const Moment& /*now*/, ServiceLoad& /*load*/) {}
  /// Each step, on what passes the meters.
  virtual void supply(const Moment& /*now*/, UtilityPower& /*power*/) {}
  /// Once for each meter, at the end.
  virtual void distort(const MeterRecord& /*record*/) const {}
};

}  // namespace recald::simulators
