#include "core/drift/named_change.hpp"

#include <algorithm>
#include <utility>

#include "core/absent.hpp"

namespace recald::drift {
namespace {

bool is_of_building(const Cause& cause) {
  return cause.kind != CauseKind::nothing && cause.kind != CauseKind::meter;
}

Cause named(const NamedEffect& name) {
  return {.kind = CauseKind::effect,
          .probability = name.probability,
          .log_evidence = kAbsent,
          .mean = kAbsent,
          .q05 = kAbsent,
          .q95 = kAbsent,
          .effect = name.effect,
          .title = name.title};
}

}  // namespace

std::vector<Cause> with_names(std::vector<Cause> causes, const NamedChange& names) {
  double nothing = 0.0;
  double of_building = 0.0;
  for (const Cause& cause : causes) {
    if (cause.kind == CauseKind::nothing) nothing += cause.probability;
    if (is_of_building(cause)) of_building += cause.probability;
  }
  for (Cause& cause : causes) {
    if (is_of_building(cause)) {
      cause.probability *= of_building > 0.0 ? names.unknown / of_building : 0.0;
    } else if (cause.kind == CauseKind::meter) {
      double likeliest = 0.0;
      cause.probability = 0.0;
      for (const NamedEffect& name : names.effects) {
        if (name.output != cause.index) continue;
        cause.probability += name.probability;
        if (name.probability <= likeliest) continue;
        likeliest = name.probability;
        cause.effect = name.effect;
        cause.title = name.title;
      }
    }
  }
  for (const NamedEffect& name : names.effects) {
    if (name.output < 0) causes.push_back(named(name));
  }
  // A meter without a month since is no cause of the months, so its names are left out.
  double something = 0.0;
  for (const Cause& cause : causes) {
    if (cause.kind != CauseKind::nothing) something += cause.probability;
  }
  for (Cause& cause : causes) {
    if (cause.kind != CauseKind::nothing && something > 0.0) {
      cause.probability *= (1.0 - nothing) / something;
    }
  }
  std::ranges::stable_sort(causes, std::ranges::greater{}, &Cause::probability);
  return causes;
}

}  // namespace recald::drift
