#include "daemon/commands/meters/try_meter.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "adapters/modbus/frame.hpp"
#include "adapters/modbus/sunspec.hpp"
#include "core/metering/units.hpp"
#include "core/weather/sensor_quantities.hpp"
#include "daemon/commands/meters/register_doubts.hpp"

namespace recald::daemon {
namespace {

using modbus::PlannedRead;
using modbus::ReadFault;
using modbus::RegisterField;
using std::chrono::milliseconds;

/// A load that is not known is taken for this share of the rating.
constexpr double kUsualShare = 0.25;
/// … and so is one below this: at night nobody can say what is usual.
constexpr double kIdleShare = 0.01;

/// The unit answers, but not with these registers.
bool is_no(const modbus::ReadFailure& failure) {
  return failure.fault == ReadFault::exception && !modbus::is_from_gateway(failure.exception_code);
}

class Attempt {
 public:
  Attempt(const MeterConfig& meter, const AskOnce& ask)
      : meter_(meter), live_(*meter.live), fields_(live_.map.fields), ask_(ask) {}

  MeterTrial run() {
    if (!find_model()) return std::move(trial_);
    // A field and its power of ten belong together, so a device's own limit may be too small.
    const auto reads = plan_reads(fields_, live_.map.function, live_.map.limits);
    if (!reads) {
      trial_.failures.push_back(reads.error().message);
      return std::move(trial_);
    }
    for (const PlannedRead& read : *reads) {
      if (!take(read, true)) return std::move(trial_);
    }
    std::ranges::stable_sort(trial_.fields, {},
                             [](const FieldTrial& one) { return one.found.field->address; });
    evaluate_resolution();
    return std::move(trial_);
  }

 private:
  /// Where the addresses of the map begin. @return whether to go on
  bool find_model() {
    if (live_.map.sunspec_models.empty()) return true;
    modbus::SunSpecWalk walk{live_.unit, live_.map.sunspec_models};
    while (const auto request = walk.next()) walk.take(ask_(*request).result);
    const auto model = walk.found();
    if (!model) {
      fail_with(walk.failure());
      return false;
    }
    base_ = model->address;
    trial_.notes.push_back(fmt::format("SunSpec model {} at address {}", model->id, base_));
    return true;
  }

  void fail_with(const modbus::ReadFailure& failure) {
    trial_.failures.push_back(failure.fault == ReadFault::timeout
                                  ? "does not answer"
                                  : fmt::format("cannot be read: {}", failure.what));
  }

  /// @param may_split  A refusal of several fields is asked again field by field.
  /// @return whether to go on
  bool take(const PlannedRead& read, bool may_split) {
    const TimedRead outcome = ask_(
        {live_.unit, read.function, static_cast<std::uint16_t>(base_ + read.address), read.count});
    if (outcome.result) {
      take_words(read, *outcome.result, outcome.duration);
      return true;
    }
    const modbus::ReadFailure& failure = outcome.result.error();
    if (!is_no(failure)) {
      fail_with(failure);
      return false;
    }
    if (may_split && read.fields.size() > 1) return take_one_by_one(read);
    for (const std::size_t i : read.fields) {
      add({&fields_[i],
           {},
           tl::unexpected("refused: exception " +
                          modbus::describe_exception(failure.exception_code))},
          outcome.duration);
    }
    return true;
  }

  bool take_one_by_one(const PlannedRead& read) {
    std::vector<RegisterField> some;
    for (const std::size_t i : read.fields) some.push_back(fields_[i]);
    modbus::ReadLimits limits = live_.map.limits;
    limits.one_request_per_field = true;
    const auto reads = plan_reads(some, read.function, limits);
    if (!reads) return true;  // what was read together a moment ago can be
    for (PlannedRead single : *reads) {
      for (std::size_t& i : single.fields) i = read.fields[i];
      if (!take(single, false)) return false;
    }
    return true;
  }

  void add(FieldWords found, milliseconds duration) {
    const auto metered = metered_fields(live_.map);
    const bool is_metered =
        std::ranges::find(metered, found.field->name, &RegisterField::name) != metered.end();
    if (is_metered && found.words.empty()) {
      trial_.failures.push_back(fmt::format("'{}' is {}", found.field->name, found.value.error()));
    }
    trial_.fields.push_back({std::move(found), duration, is_metered});
  }

  void take_words(const PlannedRead& read, const modbus::Words& words, milliseconds duration) {
    const auto values = decode_read(fields_, read, words);
    for (FieldWords& found : words_of_fields(fields_, read.address, words)) {
      const auto value = std::ranges::find_if(values, [&](const modbus::FieldValue& one) {
        return &fields_[one.field] == found.field;
      });
      if (value == values.end()) continue;  // read along, and not asked for
      if (meter_.role == MeterRole::weather && value->value) {
        const auto* const quantity = weather::find_quantity(found.field->name);
        if (quantity != nullptr && !weather::is_plausible(*quantity, value->value->value)) {
          trial_.warnings.push_back(weather::why_not_plausible(*quantity, value->value->value) +
                                    "; check address, type, scale and order in the map");
        }
      }
      if (meter_.meter.rated_kW) {
        const std::string doubt =
            doubt_about(*found.field, {read.address, words}, value->power_of_ten, limits());
        if (!doubt.empty()) trial_.warnings.push_back(doubt);
      }
      add(std::move(found), duration);
    }
  }

  [[nodiscard]] LoadLimits limits() const { return {*meter_.meter.rated_kW, meter_.multiplier}; }

  [[nodiscard]] double usual_load_kW() const {
    const double rated_kW = *meter_.meter.rated_kW;
    for (const FieldTrial& one : trial_.fields) {
      if (live_.map.power != one.found.field->name || !one.found.value) continue;
      const auto unit =
          metering::find_unit(one.found.field->unit, metering::Utility::electricity, {});
      if (!unit) continue;
      const double now_kW = std::abs(one.found.value->value) * unit->factor * meter_.multiplier;
      if (now_kW > kIdleShare * rated_kW && now_kW <= rated_kW) return now_kW;
    }
    return kUsualShare * rated_kW;
  }

  void evaluate_resolution() {
    if (!meter_.meter.rated_kW) return;
    for (const FieldTrial& one : trial_.fields) {
      const auto& energy = live_.map.energy;
      const bool counts = std::ranges::find(energy, one.found.field->name) != energy.end();
      if (!counts || !one.found.value) continue;
      const std::string coarse = coarseness_of(*one.found.field, one.found.value->resolution,
                                               usual_load_kW(), meter_.meter.interval, limits());
      if (!coarse.empty()) trial_.warnings.push_back(coarse);
    }
  }

  const MeterConfig& meter_;
  const LiveMeterConfig& live_;
  const std::vector<RegisterField>& fields_;
  const AskOnce& ask_;
  int base_ = 0;
  MeterTrial trial_;
};

}  // namespace

MeterTrial try_meter(const MeterConfig& meter, const AskOnce& ask) {
  return Attempt{meter, ask}.run();
}

}  // namespace recald::daemon
