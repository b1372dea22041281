#include "tests/blind/scoring/targets.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <limits>

namespace recald::blind {
namespace {

constexpr double kOpen = std::numeric_limits<double>::infinity();

// In the order of the enumeration.
constexpr std::array<std::string_view, 5> kVerdicts{"met", "met, not shown at this size", "missed",
                                                    "no cases", "not gated"};

constexpr Goal at_least(double value) { return {.min = value, .max = kOpen}; }
constexpr Goal at_most(double value) { return {.min = -kOpen, .max = value}; }
constexpr Goal within(double low, double high) { return {.min = low, .max = high}; }

/// 0 of 60 passes a goal of 5 %, 1 of 60 does not, 8 of 300 does: what counts is the bound.
constexpr Goal bounded_by(double value) {
  return {.min = -kOpen, .max = value, .by_bound_alone = true};
}

std::string goal_text(const Goal& goal, const char* unit, double scale) {
  if (goal.by_bound_alone) return fmt::format("bound at most {:g}{}", goal.max * scale, unit);
  if (goal.max == kOpen) return fmt::format("at least {:g}{}", goal.min * scale, unit);
  if (goal.min == -kOpen) return fmt::format("at most {:g}{}", goal.max * scale, unit);
  return fmt::format("{:g} to {:g}{}", goal.min * scale, goal.max * scale, unit);
}

Target share_target(std::string quantity, const std::optional<Score>& score, const Goal& minimum,
                    const Goal& excellent) {
  return {.quantity = std::move(quantity),
          .score = score,
          .minimum_text = goal_text(minimum, " %", 100.0),
          .excellent_text = goal_text(excellent, " %", 100.0),
          .minimum = verdict_of(score, minimum, /*exact=*/false),
          .excellent = verdict_of(score, excellent, /*exact=*/false)};
}

Target number_target(std::string quantity, const std::optional<Score>& score, const Goal& minimum,
                     const Goal& excellent) {
  return {.quantity = std::move(quantity),
          .score = score,
          .minimum_text = goal_text(minimum, "", 1.0),
          .excellent_text = goal_text(excellent, "", 1.0),
          .minimum = verdict_of(score, minimum, /*exact=*/false),
          .excellent = verdict_of(score, excellent, /*exact=*/false),
          .decimals = 3};
}

/// A method that never commits itself to a name can rank well; so this stands below its ranks.
Target named_outright(const char* quantity, const std::optional<Score>& score) {
  return {.quantity = quantity,
          .score = score,
          .minimum_text = "-",
          .excellent_text = "-",
          .minimum = Verdict::not_gated,
          .excellent = Verdict::not_gated};
}

Target slowest_target(const CostScores& cost) {
  constexpr Goal minimum = at_most(90.0);
  constexpr Goal excellent = at_most(45.0);
  std::optional<Score> slowest;
  if (cost.wall_s) {
    slowest = Score{.value = cost.wall_s->max, .cases = cost.wall_s->median->cases};
  }
  return {.quantity = "slowest case, blind profile",
          .score = slowest,
          .minimum_text = goal_text(minimum, " s", 1.0),
          .excellent_text = goal_text(excellent, " s", 1.0),
          .minimum = verdict_of(slowest, minimum, /*exact=*/true),
          .excellent = verdict_of(slowest, excellent, /*exact=*/true),
          .decimals = 1};
}

GroupScores singles_at(const NamingScores& naming, double detectability) {
  const std::string wanted = single_group(detectability);
  const auto found = std::ranges::find(naming.groups, wanted, &GroupScores::group);
  return found == naming.groups.end() ? GroupScores{} : *found;
}

}  // namespace

std::string_view verdict_name(Verdict verdict) {
  return kVerdicts[static_cast<std::size_t>(verdict)];
}

Verdict verdict_of(const std::optional<Score>& score, const Goal& goal, bool exact) {
  if (!score) return Verdict::no_cases;
  const auto& bounds = score->one_sided;
  const bool cleared = bounds && (goal.min == -kOpen || bounds->low >= goal.min) &&
                       (goal.max == kOpen || bounds->high <= goal.max);
  const bool reached = goal.by_bound_alone ? cleared || score->value == 0.0
                                           : score->value >= goal.min && score->value <= goal.max;
  if (!reached) return Verdict::missed;
  return cleared || exact ? Verdict::met : Verdict::met_not_shown;
}

std::vector<Target> targets(const NamingScores& naming, const ProbabilityScores& probability,
                            const GapScores& gap, const CostScores& cost) {
  const GroupScores at_4 = singles_at(naming, 4.0);
  const GroupScores at_8 = singles_at(naming, 8.0);
  const GroupScores at_16 = singles_at(naming, 16.0);
  return {
      share_target("false name, no effect", naming.false_names, bounded_by(0.05), bounded_by(0.01)),
      share_target("top-1, single, d* = 4", at_4.top1, at_least(0.55), at_least(0.75)),
      share_target("top-1, single, d* = 8", at_8.top1, at_least(0.75), at_least(0.90)),
      named_outright("named and nothing else, single, d* = 8", at_8.right),
      share_target("top-1, single, d* = 16", at_16.top1, at_least(0.85), at_least(0.95)),
      named_outright("named and nothing else, single, d* = 16", at_16.right),
      share_target("top-3, single, d* = 8", at_8.top3, at_least(0.88), at_least(0.97)),
      share_target("class, single, d* = 8", at_8.class_right, at_least(0.85), at_least(0.95)),
      share_target("name said with P >= 0.8 is right", probability.sure_names_right, at_least(0.85),
                   at_least(0.95)),
      number_target("calibration error (ECE)", probability.ece, at_most(0.08), at_most(0.03)),
      share_target("out of catalogue: wrong name", naming.out_of_catalogue_wrong_name,
                   at_most(0.25), at_most(0.08)),
      share_target("out of catalogue: flagged unknown", naming.out_of_catalogue_unknown,
                   at_least(0.60), at_least(0.85)),
      share_target("pair: both named (d* >= 8)", naming.pairs.both_detectable, at_least(0.45),
                   at_least(0.70)),
      number_target("gap closed (median R, d* >= 8, named)", gap.cvrmse, at_least(0.6),
                    at_least(0.85)),
      number_target("bias of parameters, after / before", gap.bias.ratio, at_most(0.5),
                    at_most(0.25)),
      share_target("90 % interval of the effect has the truth", gap.effect_coverage,
                   within(0.80, 0.97), within(0.86, 0.94)),
      share_target("harm to another meter", gap.harm, at_most(0.03), at_most(0.005)),
      slowest_target(cost)};
}

}  // namespace recald::blind
