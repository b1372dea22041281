#include "core/diagnosis/evidence/candidate_shapes.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>
#include <utility>

namespace recald::diagnosis {
namespace {

/// Without the first and last days.
std::span<const EffectParameter> own_parameters(const Candidate& candidate) {
  const std::size_t days = (candidate.begins ? 1 : 0) + (candidate.ends ? 1 : 0);
  return {candidate.parameters.data(), candidate.parameters.size() - days};
}

/// Whether an effect of these values changes nothing.
bool is_neutral(std::span<const EffectParameter> parameters, const std::vector<double>& values) {
  bool has_neutral = false;
  for (std::size_t j = 0; j < parameters.size(); ++j) {
    if (!std::isfinite(parameters[j].neutral)) continue;
    if (values[j] != parameters[j].neutral) return false;
    has_neutral = true;
  }
  return has_neutral;
}

constexpr std::ptrdiff_t kAllAmounts = -1;

/// All combinations of the scanned values, with typical amounts.
/// @param only  The only amount that is not neutral.
std::vector<std::vector<double>> shapes_with(std::span<const EffectParameter> parameters,
                                             std::ptrdiff_t only) {
  std::vector<std::vector<double>> shapes{{}};
  std::ptrdiff_t amount = 0;
  for (const EffectParameter& parameter : parameters) {
    std::vector<double> values = parameter.scan;
    if (is_amount(parameter)) {
      const bool there = only == kAllAmounts || only == amount++;
      values.push_back(there ? typical_value(parameter) : parameter.neutral);
    } else if (values.empty()) {
      values.push_back(parameter.prior.mean());
    }
    std::vector<std::vector<double>> longer;
    for (const auto& shape : shapes) {
      for (const double value : values) {
        longer.push_back(shape);
        longer.back().push_back(value);
      }
    }
    shapes = std::move(longer);
  }
  std::erase_if(shapes,
                [&](const std::vector<double>& shape) { return is_neutral(parameters, shape); });
  return shapes;
}

}  // namespace

bool is_amount(const EffectParameter& parameter) {
  return std::isfinite(parameter.neutral) && parameter.scan.empty();
}

double typical_value(const EffectParameter& parameter) {
  const double mean = parameter.prior.mean();
  const double sd = std::sqrt(parameter.prior.variance());
  return std::abs(mean - parameter.neutral) > 0.1 * sd ? mean : parameter.neutral + sd;
}

bool may_take_away(const Candidate& candidate) {
  for (const EffectParameter& parameter : candidate.parameters) {
    if (!is_amount(parameter)) continue;
    return parameter.prior.min() < parameter.neutral && parameter.prior.max() > parameter.neutral;
  }
  return false;  // Only shapes: present or absent.
}

std::vector<double> with_amount(const Candidate& candidate, std::vector<double> values,
                                double factor) {
  for (std::size_t j = 0; j < candidate.parameters.size(); ++j) {
    const EffectParameter& parameter = candidate.parameters[j];
    if (!is_amount(parameter)) continue;
    values[j] = std::clamp(parameter.neutral + factor * (values[j] - parameter.neutral),
                           parameter.prior.min(), parameter.prior.max());
  }
  return values;
}

std::vector<std::vector<double>> own_shapes(const Candidate& candidate) {
  return shapes_with(own_parameters(candidate), kAllAmounts);
}

std::vector<std::vector<double>> shapes_to_try(const Candidate& candidate) {
  const auto own = own_parameters(candidate);
  const auto amounts = std::ranges::count_if(own, is_amount);
  std::vector<std::vector<double>> shapes = own_shapes(candidate);
  for (std::ptrdiff_t only = 0; amounts > 1 && only < amounts; ++only) {
    const auto more = shapes_with(own, only);
    shapes.insert(shapes.end(), more.begin(), more.end());
  }
  return shapes;
}

}  // namespace recald::diagnosis
