#include "core/weather/sensor_quantities.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "core/absent.hpp"
#include "core/text/number_text.hpp"

namespace recald::weather {
namespace {

constexpr int kDigits = 6;

const SensorQuantity* find_by(std::string_view SensorQuantity::*text, std::string_view wanted) {
  const auto found = std::ranges::find(kSensorQuantities, wanted, text);
  return found == kSensorQuantities.end() ? nullptr : &*found;
}

}  // namespace

const SensorQuantity* find_quantity(std::string_view name) {
  return find_by(&SensorQuantity::name, name);
}

const SensorQuantity* find_quantity_of_unit(std::string_view unit) {
  return find_by(&SensorQuantity::unit, unit);
}

std::string why_not_plausible(const SensorQuantity& quantity, double value) {
  return number_text(value, kDigits) + " " + std::string{quantity.unit} + " cannot be " +
         std::string{quantity.name} + ", which lies between " + number_text(quantity.min, kDigits) +
         " and " + number_text(quantity.max, kDigits);
}

std::string quantity_units() {
  std::string units;
  for (const SensorQuantity& quantity : kSensorQuantities) {
    if (!units.empty()) units += ", ";
    units += std::string{quantity.unit} + " (" + std::string{quantity.name} + ")";
  }
  return units;
}

bool is_same_value(double a, double b) {
  return std::abs(a - b) <= 1e-9 * std::max({1.0, std::abs(a), std::abs(b)});
}

std::size_t forget_frozen(std::span<SensorValue> values, std::chrono::seconds interval) {
  std::size_t forgotten = 0;
  for (std::size_t begin = 0; begin < values.size();) {
    std::size_t end = begin + 1;
    while (end < values.size() && values[end].start - values[end - 1].start == interval &&
           is_same_value(values[end].value, values[begin].value)) {
      ++end;
    }
    if (is_frozen(interval * static_cast<std::int64_t>(end - begin), interval)) {
      for (SensorValue& frozen : values.subspan(begin, end - begin)) frozen.value = kAbsent;
      forgotten += end - begin;
    }
    begin = end;
  }
  return forgotten;
}

}  // namespace recald::weather
