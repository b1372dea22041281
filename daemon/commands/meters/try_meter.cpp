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
    trial_.is_silent = failure.fault == ReadFault::timeout;
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

  [[nodiscard]] bool is_among_metered(const RegisterField& field) const {
    const auto metered = metered_fields(live_.map);
    return std::ranges::find(metered, field.name, &RegisterField::name) != metered.end();
  }

  /// A value that cannot be is a failure where the meter is made of it.
  void doubt(const RegisterField& field, const std::string& sentence) {
    if (sentence.empty()) return;
    (is_among_metered(field) ? trial_.failures : trial_.warnings).push_back(sentence);
  }

  void add(FieldWords found, milliseconds duration) {
    const bool is_metered = is_among_metered(*found.field);
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
          doubt(*found.field, weather::why_not_plausible(*quantity, value->value->value) +
                                  "; check address, type, scale and order in the map");
        }
      }
      if (meter_.meter.rated_kW) {
        doubt(*found.field,
              doubt_about(*found.field, {read.address, words}, value->power_of_ten, limits()));
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

std::vector<std::string> impossible_rises(const MeterConfig& meter, const MeterTrial& first,
                                          const MeterTrial& second, milliseconds between) {
  std::vector<std::string> sentences;
  if (!meter.meter.rated_kW) return sentences;
  for (const std::string& name : meter.live->map.energy) {
    const auto found_in = [&](const MeterTrial& trial) {
      return std::ranges::find_if(trial.fields, [&](const FieldTrial& one) {
        return one.found.field->name == name && one.found.value;
      });
    };
    const auto before = found_in(first);
    const auto after = found_in(second);
    if (before == first.fields.end() || after == second.fields.end()) continue;
    const auto unit =
        metering::find_unit(after->found.field->unit, metering::Utility::electricity, {});
    if (!unit) continue;
    const double factor = unit->factor * meter.multiplier;
    const double rise_kWh = (after->found.value->value - before->found.value->value) * factor;
    const auto span = std::chrono::ceil<std::chrono::seconds>(between);
    const metering::CounterSettings settings{
        .rated_kW = *meter.meter.rated_kW,
        .resolution_kWh = after->found.value->resolution * factor};
    if (rise_kWh <= rise_max_kWh(span, settings)) continue;
    const double seconds = static_cast<double>(between.count()) / 1000.0;
    sentences.push_back(fmt::format(
        "'{}' rose by {:.4g} kWh in {:.1f} s, which is {:.4g} kW and impossible for a load of "
        "{:.4g} kW; it may count Wh where the map says kWh: compare scale and unit in the map with "
        "the meter's display",
        name, rise_kWh, seconds, rise_kWh * 3600.0 / seconds, *meter.meter.rated_kW));
  }
  return sentences;
}

}  // namespace recald::daemon
