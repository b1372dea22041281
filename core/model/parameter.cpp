#include "core/model/parameter.hpp"

#include <cassert>
#include <cmath>
#include <locale>
#include <sstream>

namespace recald {

Result<TriangularPrior> TriangularPrior::make(double min, double mode, double max) {
  const bool finite = std::isfinite(min) && std::isfinite(mode) && std::isfinite(max);
  if (!finite || !(min < max) || mode < min || mode > max) {
    std::ostringstream text;
    text.imbue(std::locale::classic());
    text << "a triangular prior needs min <= mode <= max and min < max, but min = " << min
         << ", mode = " << mode << ", max = " << max;
    return failure(ErrorCode::invalid_value, text.str());
  }
  return TriangularPrior{min, mode, max};
}

double TriangularPrior::density(double value) const {
  if (value < min || value > max) return 0.0;
  const double range = max - min;
  if (value < mode) return 2.0 * (value - min) / (range * (mode - min));
  if (value > mode) return 2.0 * (max - value) / (range * (max - mode));
  return 2.0 / range;
}

double TriangularPrior::cumulative(double value) const {
  if (value <= min) return 0.0;
  if (value >= max) return 1.0;
  const double range = max - min;
  if (value <= mode) return (value - min) * (value - min) / (range * (mode - min));
  return 1.0 - (max - value) * (max - value) / (range * (max - mode));
}

double TriangularPrior::quantile(double probability) const {
  assert(probability >= 0.0 && probability <= 1.0);
  const double range = max - min;
  const double at_mode = (mode - min) / range;
  if (probability < at_mode) return min + std::sqrt(probability * range * (mode - min));
  return max - std::sqrt((1.0 - probability) * range * (max - mode));
}

double TriangularPrior::variance() const {
  return (min * min + mode * mode + max * max - min * mode - min * max - mode * max) / 18.0;
}

std::string describe(std::span<const Parameter> parameters, std::span<const double> values) {
  assert(parameters.size() == values.size());
  std::ostringstream text;
  text.imbue(std::locale::classic());
  for (std::size_t j = 0; j < parameters.size(); ++j) {
    if (j > 0) text << ", ";
    text << parameters[j].name << " = " << values[j];
    if (!parameters[j].unit.empty()) text << ' ' << parameters[j].unit;
  }
  return text.str();
}

}  // namespace recald
