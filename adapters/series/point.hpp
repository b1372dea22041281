/// Measurements with a time, as databases of time series take them.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "core/metering/civil_time.hpp"

namespace recald::series {

struct Field {
  std::string name;  ///< Ends in the unit: "mean_kilowatts". [a-zA-Z_][a-zA-Z0-9_]*
  double value;      ///< One that is not finite is left out.
};

/// One measurement at one time.
struct Point {
  std::string measurement;  ///< "recald_interval". [a-zA-Z_][a-zA-Z0-9_]*
  /// Name and value: site, meter, … Names as `Field::name`, each once, neither "time" nor
  /// "__name__". Values are UTF-8; an empty one is as none.
  std::vector<std::pair<std::string, std::string>> labels;
  metering::Instant time;
  std::vector<Field> fields;
};

}  // namespace recald::series
