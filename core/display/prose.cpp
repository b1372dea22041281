#include "core/display/prose.hpp"

#include <cmath>
#include <regex>

namespace recald::display {
namespace {

std::string fahrenheit(const std::string& celsius) {
  const double shown = unit_of(UnitSystem::ip, "degC").shown(std::stod(celsius));
  return std::to_string(std::lround(shown));
}

}  // namespace

std::string with_temperatures_in(UnitSystem system, const std::string& text) {
  if (system == UnitSystem::si) return text;
  static const std::regex kTemperature{"(?:(-?[0-9.]+) (to|and) )?(-?[0-9.]+) °C"};
  std::string shown;
  auto rest = text.cbegin();
  for (std::sregex_iterator it{text.begin(), text.end(), kTemperature}, end; it != end; ++it) {
    const std::smatch& found = *it;
    shown.append(rest, found[0].first);
    if (found[1].matched) shown += fahrenheit(found[1]) + " " + found[2].str() + " ";
    shown += fahrenheit(found[3]) + " °F";
    rest = found[0].second;
  }
  return shown.append(rest, text.cend());
}

}  // namespace recald::display
