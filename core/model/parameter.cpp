#include "core/model/parameter.hpp"

#include <cassert>
#include <cmath>
#include <locale>
#include <sstream>

namespace recald {

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

std::vector<const model::ParameterDefinition*> definitions_of(
    std::span<const Parameter> parameters) {
  std::vector<const model::ParameterDefinition*> definitions;
  for (const Parameter& parameter : parameters) definitions.push_back(parameter.definition);
  return definitions;
}

std::vector<double> prior_modes(std::span<const Parameter> parameters) {
  std::vector<double> theta;
  for (const Parameter& parameter : parameters) theta.push_back(parameter.prior.mode());
  return theta;
}

std::vector<double> prior_means(std::span<const Parameter> parameters) {
  std::vector<double> theta;
  for (const Parameter& parameter : parameters) theta.push_back(parameter.prior.mean());
  return theta;
}

}  // namespace recald
