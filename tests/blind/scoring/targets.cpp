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

std::string goal_text(const Goal& goal, const char* unit, double scale) {
  if (goal.max == kOpen) return fmt::format("at least {:g}{}", goal.min * scale, unit);
  if (goal.min == -kOpen) return fmt::format("at most {:g}{}", goal.max * scale, unit);
  return fmt::format("{:g} to {:g}{}", goal.min * scale, goal.max * scale, unit);
}

/// What one world asks. Issues of a release fix these before its answers are opened.
struct Wanted {
  Goal named_above_10, aim_above_10;
  Goal named_3_to_10, aim_3_to_10;
  Goal top1_above_10, top1_3_to_10;
  Goal false_names, wrong_names;
  Goal sure_names, slope, coverage, gap;
};

constexpr Wanted kOwnWorld{.named_above_10 = at_least(0.65),
                           .aim_above_10 = at_least(0.80),
                           .named_3_to_10 = at_least(0.40),
                           .aim_3_to_10 = at_least(0.60),
                           .top1_above_10 = at_least(0.85),
                           .top1_3_to_10 = at_least(0.65),
                           .false_names = at_most(0.02),
                           .wrong_names = at_most(0.08),
                           .sure_names = at_least(0.92),
                           .slope = within(0.8, 1.25),
                           .coverage = within(0.80, 0.95),
                           .gap = at_least(0.8)};
constexpr Wanted kEnergyPlus{.named_above_10 = at_least(0.50),
                             .aim_above_10 = at_least(0.70),
                             .named_3_to_10 = at_least(0.30),
                             .aim_3_to_10 = at_least(0.50),
                             .top1_above_10 = at_least(0.75),
                             .top1_3_to_10 = at_least(0.50),
                             .false_names = at_most(0.04),
                             .wrong_names = at_most(0.10),
                             .sure_names = at_least(0.88),
                             .slope = within(0.75, 1.33),
                             .coverage = within(0.75, 0.95),
                             .gap = at_least(0.7)};

/// How a figure is shown: shares in per cent.
struct Unit {
  const char* text;
  double scale;
  std::optional<int> decimals;
  bool exact = false;  ///< A figure that stands as it is.
};
constexpr Unit kPerCent{" %", 100.0, std::nullopt};
constexpr Unit kNumber{"", 1.0, 3};
constexpr Unit kSeconds{" s", 1.0, 1, true};

Target target(std::string quantity, const std::optional<Score>& score, const Unit& unit,
              const Goal& minimum, const std::optional<Goal>& excellent = {}) {
  return {.world = {},
          .quantity = std::move(quantity),
          .score = score,
          .minimum_text = goal_text(minimum, unit.text, unit.scale),
          .excellent_text = excellent ? goal_text(*excellent, unit.text, unit.scale) : "-",
          .minimum = verdict_of(score, minimum, unit.exact),
          .excellent = excellent ? verdict_of(score, *excellent, unit.exact) : Verdict::not_gated,
          .decimals = unit.decimals};
}

std::optional<Score> slowest_of(const CostScores& cost) {
  if (!cost.wall_s) return std::nullopt;
  return Score{.value = cost.wall_s->max, .cases = cost.wall_s->median->cases};
}

GroupScores singles_at(const NamingScores& naming, double share) {
  const std::string wanted = single_group(share);
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
  if (score->value < goal.min || score->value > goal.max) return Verdict::missed;
  return cleared || exact ? Verdict::met : Verdict::met_not_shown;
}

std::vector<Target> targets(const std::string& world, const NamingScores& naming,
                            const ProbabilityScores& probability, const GapScores& gap,
                            const CostScores& cost) {
  constexpr double kSlowest_s = 10.0;
  const GroupScores above_10 = singles_at(naming, 0.10);
  const GroupScores from_3 = singles_at(naming, 0.03);
  const Wanted& wanted = world == "own" ? kOwnWorld : kEnergyPlus;
  std::vector<Target> all{
      target("named right, above 10 %", above_10.right, kPerCent, wanted.named_above_10,
             wanted.aim_above_10),
      target("named right, 3 to 10 %", from_3.right, kPerCent, wanted.named_3_to_10,
             wanted.aim_3_to_10),
      target("top-1, above 10 %", above_10.top1, kPerCent, wanted.top1_above_10),
      target("top-1, 3 to 10 %", from_3.top1, kPerCent, wanted.top1_3_to_10),
      target("false name where nothing is hidden", naming.false_names, kPerCent,
             wanted.false_names),
      target("wrong name where something is", naming.wrong_names, kPerCent, wanted.wrong_names),
      target("name said with P >= 0.8 is right", probability.sure_names_right, kPerCent,
             wanted.sure_names),
      target("slope of the probabilities", probability.slope, kNumber, wanted.slope),
      target("90 % interval of the effect has the truth", gap.effect_coverage, kPerCent,
             wanted.coverage),
      target("gap closed (median R, 3 % and more, named)", gap.cvrmse, kNumber, wanted.gap),
      target("slowest case", slowest_of(cost), kSeconds, at_most(kSlowest_s))};
  for (Target& each : all) each.world = world;
  return all;
}

}  // namespace recald::blind
