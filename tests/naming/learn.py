"""Writes what a diagnosis uses for names by signatures: learnt_names.cpp.

    learn.py NULL OUT PROVENANCE OWN_TABLES:OWN_ANSWERS[,…] ENERGYPLUS_TABLES:ENERGYPLUS_ANSWERS[,…]

NULL is null.py's; the tables hold evidence beside it. Weights are learnt in both worlds, each counting alike.
"""
import json
import pathlib
import sys
import textwrap

import numpy as np

import study

PATTERNS = 40
STEPS = 127  # Of a pattern's largest entry.


def compressed(null):
    """The rows' main patterns in whole steps, and what is left of each signature's variance."""
    rows = np.array([row["values"] for row in null["rows"]])
    _, sizes, directions = np.linalg.svd(rows, full_matrices=False)
    patterns = directions[:PATTERNS] * sizes[:PATTERNS, None]
    step = np.abs(patterns).max(axis=1) / STEPS
    steps = np.rint(patterns / step[:, None]).astype(int)
    step = np.array([float(f"{x:.4g}") for x in step])
    left = (rows**2).sum(axis=0) - ((steps * step[:, None]) ** 2).sum(axis=0)
    return steps, step, null["own"] + np.maximum(left, 0.0)


def numbers(values, form="{:.4g}"):
    return textwrap.fill(", ".join(form.format(value) for value in values), 98, initial_indent="    ", subsequent_indent="    ")


def main():
    null_file, out, provenance, *folders = sys.argv[1:]
    null = json.loads(pathlib.Path(null_file).read_text())
    worlds = [study.judged_of(world, given) for world, given in zip(("own", "energyplus"), folders)]
    weights = study.Logit(*worlds).weights
    effect, site = len(study.FEATURES), (len(weights) - len(study.FEATURES)) // 2
    steps, step, own = compressed(null)
    parameters = "\n".join(f'    {{"{name}", {null["centre"][name]:.3g}, {null["reach"][name]:.3g}}},' for name in sorted(null["reach"]))
    lists = {name: numbers(part) for name, part in zip(("effect", "none", "unknown"), np.split(weights, (effect, effect + site)))}
    pathlib.Path(out).write_text(f"""// Written by tests/naming/learn.py.
{textwrap.fill(provenance, 98, initial_indent="// ", subsequent_indent="// ")}
#include "core/diagnosis/naming/learnt_names.hpp"

#include <array>
#include <cstdint>

namespace recald::diagnosis {{
namespace {{

// clang-format off
constexpr Eigen::Index kLearntEntries = {len(own)};
constexpr Eigen::Index kLearntPatterns = {PATTERNS};

struct LearntScores {{
  const char* parameter;
  double centre;
  double reach;
}};
constexpr auto kLearntScores = std::to_array<LearntScores>({{
{parameters}
}});

constexpr std::array<double, kLearntEntries> kLearntSpread{{
{numbers(null["spread"])}}};

constexpr std::array<double, kLearntEntries> kLearntOwn{{
{numbers(own, "{:.3g}")}}};

constexpr std::array<double, kLearntPatterns> kLearntStep{{
{numbers(step)}}};

/// Pattern by pattern, in steps.
constexpr std::array<std::int8_t, kLearntEntries * kLearntPatterns> kLearntPatternSteps{{
{numbers(steps.ravel(), "{:d}")}}};

constexpr std::array<double, kEffectFeatures> kLearntOfEffect{{
{lists["effect"]}}};
constexpr std::array<double, kSiteFeatures> kLearntOfNone{{
{lists["none"]}}};
constexpr std::array<double, kSiteFeatures> kLearntOfUnknown{{
{lists["unknown"]}}};
// clang-format on

SignatureNull unpack_null() {{
  SignatureNull null;
  null.spread = Eigen::Map<const Eigen::VectorXd>(kLearntSpread.data(), kLearntEntries);
  null.own = Eigen::Map<const Eigen::VectorXd>(kLearntOwn.data(), kLearntEntries);
  null.patterns =
      Eigen::Map<const Eigen::Matrix<std::int8_t, kLearntEntries, kLearntPatterns>>(
          kLearntPatternSteps.data())
          .cast<double>() *
      Eigen::Map<const Eigen::VectorXd>(kLearntStep.data(), kLearntPatterns).asDiagonal();
  for (const LearntScores& of : kLearntScores) {{
    null.centre[of.parameter] = of.centre;
    null.reach[of.parameter] = of.reach;
  }}
  return null;
}}

}}  // namespace

const SignatureNull& learnt_null() {{
  static const SignatureNull null = unpack_null();
  return null;
}}

const NameWeights& learnt_weights() {{
  static const NameWeights weights{{
      .effect = Eigen::Vector<double, kEffectFeatures>(kLearntOfEffect.data()),
      .none = Eigen::Vector<double, kSiteFeatures>(kLearntOfNone.data()),
      .unknown = Eigen::Vector<double, kSiteFeatures>(kLearntOfUnknown.data())}};
  return weights;
}}

}}  // namespace recald::diagnosis
""")


if __name__ == "__main__":
    main()
