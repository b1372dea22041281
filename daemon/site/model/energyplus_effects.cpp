#include "daemon/site/model/energyplus_effects.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <variant>

#include "adapters/energyplus/effect_patch.hpp"
#include "daemon/site/model/active_effects.hpp"

namespace recald::daemon {
namespace {

using diagnosis::AddedEffect;

/// Without those that are dates.
std::size_t count_values(const AddedEffect& effect) {
  return effect.parameters.size() - (effect.from ? 1 : 0) - (effect.to ? 1 : 0);
}

/// A design has ends: what lies beyond them is as good as impossible.
Prior with_ends(const Prior& prior) {
  constexpr double kTail = 0.0025;
  if (std::isfinite(prior.min()) && std::isfinite(prior.max())) return prior;
  return std::visit(
      [&](auto ended) -> Prior {
        if (!std::isfinite(ended.min)) ended.min = prior.quantile(kTail);
        if (!std::isfinite(ended.max)) ended.max = prior.quantile(1.0 - kTail);
        return ended;
      },
      prior.distribution());
}

Result<void> require_patch(const AddedEffect& effect) {
  const auto known = energyplus::patched_effects();
  if (std::ranges::find(known, effect.effect) != known.end()) return {};
  return failure(ErrorCode::unsupported,
                 fmt::format("an EnergyPlus model cannot be given the effect '{}', so it cannot be "
                             "calibrated while a model version with it is in force; `recald model "
                             "revert` takes it out",
                             effect.title));
}

}  // namespace

Result<void> take_in_effects(const diagnosis::ModelVersion& version, ModelConfig& model) {
  if (version.effects.empty()) return {};
  for (const AddedEffect& effect : version.effects) {
    if (auto known = require_patch(effect); !known) return known;
    const std::size_t values = count_values(effect);
    EffectOfModel taken{effect.effect, {}, effect.from, effect.to};
    for (std::size_t j = 0; j < values; ++j) taken.parameters.push_back(effect.parameters[j].name);
    const auto of_model = std::make_shared<const EffectOfModel>(std::move(taken));
    for (std::size_t j = 0; j < values; ++j) {
      const diagnosis::EffectParameterRecord& record = effect.parameters[j];
      model.parameters.push_back({.name = effect_parameter_name(effect, record),
                                  .prior = with_ends(record.prior),
                                  .source = "the catalogue of effects",
                                  .unit = record.unit,
                                  .effect = of_model});
    }
  }
  model.energyplus->design += "-" + diagnosis::short_version(version.version);
  return {};
}

}  // namespace recald::daemon
