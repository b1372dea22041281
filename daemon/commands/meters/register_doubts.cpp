#include "daemon/commands/meters/register_doubts.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <array>
#include <cassert>
#include <cmath>
#include <optional>

#include "core/metering/units.hpp"

namespace recald::daemon {
namespace {

using modbus::RegisterField;
using modbus::ValueFormat;
using modbus::WordOrder;

constexpr double kRatedMargin = 1.2;
constexpr double kHoursMax = 40.0 * 8766.0;
/// A float with its words in the wrong order is often such a number.
constexpr double kNextToNothing = 1e-6;
constexpr double kCoarse = 0.01;

std::optional<metering::UnitConversion> unit_of(const RegisterField& field) {
  const auto unit = metering::find_unit(field.unit, metering::Utility::electricity, {});
  return unit ? std::optional{*unit} : std::nullopt;
}

/// The registers of one field, judged under several readings of them.
class Trial {
 public:
  Trial(const RegisterField& field, const ReadWords& read, double power_of_ten,
        const LoadLimits& limits)
      : field_(field), read_(read), power_of_ten_(power_of_ten), limits_(limits) {}

  /// In the field's unit; none where there is no value or it cannot be.
  [[nodiscard]] std::optional<double> believable(const ValueFormat& format, int shift) const {
    const auto value = decoded(format, shift);
    if (!value || !is_possible(*value)) return {};
    return value;
  }

  [[nodiscard]] std::optional<double> decoded(const ValueFormat& format, int shift) const {
    const int begin = field_.address + shift - read_.address;
    const int words = modbus::word_count(format.type);
    if (begin < 0 || begin + words > static_cast<int>(read_.words.size())) return {};
    const auto value = modbus::decode(
        read_.words.subspan(static_cast<std::size_t>(begin), static_cast<std::size_t>(words)),
        format);
    if (!value) return {};
    return value->value * power_of_ten_;
  }

  [[nodiscard]] bool is_possible(double value) const {
    const auto unit = unit_of(field_);
    assert(unit && "only powers and energies are judged");
    const double size = value * unit->factor * limits_.multiplier;
    if (size != 0.0 && std::abs(size) < kNextToNothing) return false;
    const double rated_kW = kRatedMargin * limits_.rated_kW;
    if (unit->is_rate) return std::abs(size) <= rated_kW;
    return size >= 0.0 && size <= rated_kW * kHoursMax;
  }

 private:
  const RegisterField& field_;
  const ReadWords& read_;
  double power_of_ten_;
  LoadLimits limits_;
};

std::optional<modbus::RegisterType> with_a_sign(modbus::RegisterType type) {
  switch (type) {
    case modbus::RegisterType::u16:
      return modbus::RegisterType::i16;
    case modbus::RegisterType::u32:
      return modbus::RegisterType::i32;
    case modbus::RegisterType::u64:
      return modbus::RegisterType::i64;
    default:
      return {};
  }
}

/// Each mistake that would explain the value, as what it would be without it.
std::vector<std::string> explanations(const RegisterField& field, const Trial& trial) {
  std::vector<std::string> found;
  const auto offer = [&](const ValueFormat& format, int shift, const std::string& words) {
    const auto value = trial.believable(format, shift);
    // Nothing is easier to find than a zero.
    if (value && *value != 0.0)
      found.push_back(fmt::format("{:.6g} {} {}", *value, field.unit, words));
  };
  if (field.words() > 1) {
    for (const WordOrder order :
         {WordOrder::ABCD, WordOrder::CDAB, WordOrder::BADC, WordOrder::DCBA}) {
      if (order == field.format.order) continue;
      ValueFormat format = field.format;
      format.order = order;
      offer(format, 0, fmt::format("with order {}", modbus::to_string(order)));
    }
  }
  offer(field.format, -1, "one address lower (is the map's base right?)");
  offer(field.format, 1, "one address higher (is the map's base right?)");
  if (const auto type = with_a_sign(field.format.type)) {
    ValueFormat format = field.format;
    format.type = *type;
    offer(format, 0, fmt::format("with a sign, as {}", modbus::to_string(*type)));
  }
  return found;
}

}  // namespace

std::string doubt_about(const RegisterField& field, const ReadWords& read, double power_of_ten,
                        const LoadLimits& limits) {
  if (!unit_of(field)) return "";
  const Trial trial{field, read, power_of_ten, limits};
  const auto own =
      modbus::decode(read.words.subspan(static_cast<std::size_t>(field.address - read.address),
                                        static_cast<std::size_t>(field.words())),
                     field.format);
  // "No value" is an answer; a NaN may be a wrong order of words.
  if (!own && own.error() == modbus::ValueFault::absent) return "";
  const auto value = trial.decoded(field.format, 0);
  if (value && trial.is_possible(*value)) return "";
  const std::string is = value ? fmt::format("{:.6g} {}", *value, field.unit) : "not a number";
  const auto others = explanations(field, trial);
  if (others.empty()) {
    return fmt::format(
        "'{}' is {}, which is impossible for a load of {:.6g} kW; compare its address, type, scale "
        "and unit in the map with the meter's display",
        field.name, is, limits.rated_kW);
  }
  return fmt::format("'{}' is {}, which is impossible for a load of {:.6g} kW; it would be {}",
                     field.name, is, limits.rated_kW, fmt::join(others, ", or "));
}

std::string coarseness_of(const RegisterField& field, double resolution, double load_kW,
                          std::chrono::seconds interval, const LoadLimits& limits) {
  const auto unit = unit_of(field);
  if (!unit || unit->is_rate) return "";
  const double step_kWh = resolution * unit->factor * limits.multiplier;
  const double interval_kWh = load_kW * static_cast<double>(interval.count()) / 3600.0;
  if (step_kWh <= kCoarse * interval_kWh) return "";
  return fmt::format(
      "'{}' counts in steps of {:.4g} kWh, {:.2g} % of the energy of {:.4g} kW in {} minutes; {}",
      field.name, step_kWh, 100.0 * step_kWh / interval_kWh, load_kW, interval.count() / 60,
      field.format.type == modbus::RegisterType::f32
          ? "a float loses resolution as it grows, so use the integer or 64-bit copy if there is "
            "one"
          : "its intervals will be inaccurate, and its peaks even more so");
}

}  // namespace recald::daemon
