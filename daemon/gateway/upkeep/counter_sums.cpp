#include "daemon/gateway/upkeep/counter_sums.hpp"

#include <fmt/format.h>

#include <cmath>
#include <map>
#include <optional>

namespace recald::daemon {
namespace {

using metering::Instant;
using metering::Reason;
using metering::RegisterSample;
using metering::Validity;

constexpr std::chrono::seconds kSamplesApartMax{300};
constexpr double kShareOff = 0.001;
/// Across an interval with one of these reasons, register readings cannot be compared.
constexpr Reason kBroken =
    Reason::rollover | Reason::wrap | Reason::reset | Reason::jump | Reason::bounce | Reason::clock;

/// The register at each UTC midnight between two samples.
Result<std::map<Instant, double>> midnights(IntervalStore& store, std::uint32_t meter) {
  std::map<Instant, double> register_kWh;
  std::optional<RegisterSample> before;
  TRY(store.for_each_sample(meter, "energy", [&](const RegisterSample& sample) {
    const Instant midnight = std::chrono::floor<std::chrono::days>(sample.time);
    if (sample.time == midnight) {
      register_kWh[midnight] = sample.value_kWh;
    } else if (before && before->time < midnight &&
               sample.time - before->time <= kSamplesApartMax) {
      const double share =
          std::chrono::duration<double>(midnight - before->time) / (sample.time - before->time);
      register_kWh[midnight] = before->value_kWh + share * (sample.value_kWh - before->value_kWh);
    }
    before = sample;
  }));
  return register_kWh;
}

struct DaySum {
  double energy_kWh = 0.0;
  std::chrono::seconds length{0};
};

/// Sums of the days whose intervals all came from one unbroken run of the register.
Result<std::map<Instant, DaySum>> day_sums(IntervalStore& store, const StoredMeter& meter) {
  std::map<Instant, DaySum> sums;
  TRY(store.for_each_interval(
      meter.number, {Instant::min(), Instant::max()}, [&](const StoredInterval& interval) {
        const metering::Reading& reading = interval.reading;
        const bool counts =
            reading.validity == Validity::ok || reading.validity == Validity::scaled;
        if (!counts || has(reading.reasons, kBroken)) return;
        DaySum& sum = sums[std::chrono::floor<std::chrono::days>(reading.start)];
        sum.energy_kWh +=
            reading.mean_kW * static_cast<double>(meter.meter.interval.count()) / 3600.0;
        sum.length += meter.meter.interval;
      }));
  std::erase_if(sums, [](const auto& day) { return day.second.length < std::chrono::days{1}; });
  return sums;
}

}  // namespace

Result<CounterComparison> compare_with_counter(IntervalStore& store, const StoredMeter& meter) {
  CounterComparison comparison;
  const auto states = TRY(store.registers(meter.number));
  if (states.empty()) return comparison;
  const double resolution_kWh = states.front().settings.resolution_kWh;
  const auto register_kWh = TRY(midnights(store, meter.number));
  const auto edited = TRY(store.edited_days(meter.number));
  const auto sums = TRY(day_sums(store, meter));
  for (const auto& [day, sum] : sums) {
    const auto begin = register_kWh.find(day);
    const auto end = register_kWh.find(day + std::chrono::days{1});
    if (begin == register_kWh.end() || end == register_kWh.end() || edited.contains(day)) {
      continue;
    }
    ++comparison.days;
    const double counted_kWh = end->second - begin->second;
    const double tolerance_kWh = 2.0 * resolution_kWh + kShareOff * std::abs(counted_kWh) + 1e-6;
    if (std::abs(sum.energy_kWh - counted_kWh) <= tolerance_kWh) continue;
    comparison.problems.push_back(fmt::format(
        "meter '{}', {} UTC: its intervals sum to {:.2f} kWh, but its counter rose by {:.2f} kWh",
        meter.meter.id, metering::to_string(day).substr(0, 10), sum.energy_kWh, counted_kWh));
  }
  return comparison;
}

}  // namespace recald::daemon
