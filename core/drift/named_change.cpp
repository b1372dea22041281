#include "core/drift/named_change.hpp"

#include <algorithm>
#include <utility>

#include "core/absent.hpp"

namespace recald::drift {
namespace {

bool is_of_building(const Cause& cause) {
  return cause.kind != CauseKind::nothing && cause.kind != CauseKind::meter;
}

Cause named(const NamedEffect& name, double something) {
  return {.kind = CauseKind::effect,
          .probability = something * name.probability,
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
  const double something = 1.0 - nothing;
  double named_share = 0.0;
  for (Cause& cause : causes) {
    if (cause.kind != CauseKind::meter) continue;
    double likeliest = 0.0;
    cause.probability = 0.0;
    for (const NamedEffect& name : names.effects) {
      if (name.output != cause.index) continue;
      cause.probability += something * name.probability;
      named_share += name.probability;
      if (name.probability <= likeliest) continue;
      likeliest = name.probability;
      cause.effect = name.effect;
      cause.title = name.title;
    }
  }
  for (const NamedEffect& name : names.effects) {
    if (name.output < 0) named_share += name.probability;
  }
  // Of what the hours do not know, and of meters that have no month since and cannot be blamed.
  const double unnamed = something * std::max(1.0 - named_share, 0.0);
  for (Cause& cause : causes) {
    if (is_of_building(cause) && of_building > 0.0) cause.probability *= unnamed / of_building;
  }
  for (const NamedEffect& name : names.effects) {
    if (name.output < 0) causes.push_back(named(name, something));
  }
  std::ranges::stable_sort(causes, std::ranges::greater{}, &Cause::probability);
  return causes;
}

}  // namespace recald::drift
