#include "simulators/devices/load_shape.hpp"

#include <algorithm>
#include <cassert>

namespace recald::simulators {
namespace {

using std::chrono::milliseconds;

double hours(milliseconds span) { return static_cast<double>(span.count()) / 3.6e6; }

}  // namespace

LoadShape::LoadShape(SimulatedTime begin, milliseconds step, std::vector<double> kW, bool repeats)
    : begin_(begin), step_(step), power_kW_(std::move(kW)), repeats_(repeats) {
  assert(step_.count() > 0 && !power_kW_.empty());
  before_kWh_.push_back(0.0);
  for (const double power_kW : power_kW_) {
    before_kWh_.push_back(before_kWh_.back() + power_kW * hours(step_));
  }
}

LoadShape LoadShape::constant(double kW) {
  return LoadShape{SimulatedTime{}, std::chrono::hours{24}, {kW}, true};
}

LoadShape LoadShape::daily(std::vector<double> hours_kW) {
  assert(hours_kW.size() == 24);
  return LoadShape{SimulatedTime{}, std::chrono::hours{1}, std::move(hours_kW), true};
}

LoadShape LoadShape::recorded(metering::Instant begin, std::chrono::seconds step,
                              std::vector<double> kW) {
  return LoadShape{begin, step, std::move(kW), false};
}

LoadShape::Place LoadShape::place(SimulatedTime t) const {
  const milliseconds whole = step_ * static_cast<std::int64_t>(power_kW_.size());
  milliseconds since = t - begin_;
  std::int64_t rounds = 0;
  if (repeats_) {
    rounds = since / whole - (since % whole < milliseconds{0} ? 1 : 0);
    since -= rounds * whole;
  } else {
    since = std::clamp(since, milliseconds{0}, whole);
  }
  return {rounds, static_cast<std::size_t>(since / step_), since % step_};
}

double LoadShape::power_kW(SimulatedTime t) const {
  if (!repeats_ && t < begin_) return 0.0;
  const Place at = place(t);
  return at.step < power_kW_.size() ? power_kW_[at.step] : 0.0;
}

double LoadShape::counted_kWh(SimulatedTime t) const {
  const Place at = place(t);
  const double step_kW = at.step < power_kW_.size() ? power_kW_[at.step] : 0.0;
  return static_cast<double>(at.rounds) * before_kWh_.back() + before_kWh_[at.step] +
         step_kW * hours(at.since);
}

}  // namespace recald::simulators
