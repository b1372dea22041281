#include "core/diagnosis/model_version.hpp"

#include <algorithm>

namespace recald::diagnosis {

bool may_learn_from(const AddedEffect& effect, metering::Month month) {
  return std::ranges::all_of(effect.months_used, [&](auto used) { return used < month; });
}

std::string effect_parameter_name(const AddedEffect& effect,
                                  const EffectParameterRecord& parameter) {
  const std::string owner =
      effect.meter.empty() ? effect.effect : effect.effect + "_" + effect.meter;
  return owner + "_" + parameter.name;
}

}  // namespace recald::diagnosis
