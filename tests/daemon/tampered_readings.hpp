/// Readings that somebody has changed.
#pragma once

#include <sstream>
#include <string>

namespace recald::daemon::testing {

/// Readings of one meter multiplied from an instant on: somebody changed a transformer.
inline std::string multiplied(const std::string& readings, const std::string& meter,
                              const std::string& from, double factor) {
  std::istringstream in{readings};
  std::string text;
  for (std::string line; std::getline(in, line);) {
    std::istringstream fields{line};
    std::string stamp, name, value, unit;
    std::getline(fields, stamp, ',');
    std::getline(fields, name, ',');
    std::getline(fields, value, ',');
    std::getline(fields, unit, ',');
    if (name == meter && stamp >= from && !value.empty()) {
      text += stamp + "," + name + "," + std::to_string(factor * std::stod(value)) + "," + unit;
    } else {
      text += line;
    }
    text += '\n';
  }
  return text;
}

}  // namespace recald::daemon::testing
