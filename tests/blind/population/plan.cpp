#include "tests/blind/population/plan.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <string_view>

#include "tests/blind/population/draw_building.hpp"

namespace recald::blind {
namespace {

using namespace simulators;
using std::chrono::days;
using std::chrono::sys_days;

constexpr double kPlain = 8.0;
constexpr double kStrong = 16.0;
// A strength is found within 5 %, and neither effect of a pair may fall below 8.
constexpr double kInPair = 8.43;
constexpr int kStandIns = 12;

/// Streams of one population's seed. A case's own numbers come from its index.
enum class Chance : std::uint64_t { order = 1, cases = 1'000 };

std::uint64_t seed_of(std::string_view population, std::uint64_t seed) {
  std::uint64_t hash = 14695981039346656037ULL ^ seed;
  for (const char c : population) hash = (hash ^ static_cast<unsigned char>(c)) * 1099511628211ULL;
  return hash;
}

// Populations are dealt from these first, so that a seed goes on giving the buildings it gave
// before kinds came in order of their names.
constexpr auto kDealtFirst = std::to_array<std::string_view>(
    {"night_setback_missing", "weekend_operation", "missing_holidays", "after_hours", "early_start",
     "round_the_clock_zone", "semester_calendar", "vacancy", "hybrid_work"});

std::vector<const EffectKind*> kinds_in_catalogue(bool in_catalogue) {
  std::vector<const EffectKind*> kinds;
  for (const EffectKind& kind : effect_kinds()) {
    if (kind.group == EffectClass::operators) continue;  // a base parameter's, no effect is missing
    if ((kind.group != EffectClass::outside_catalogue) == in_catalogue) kinds.push_back(&kind);
  }
  std::ranges::stable_sort(kinds, {}, [](const EffectKind* kind) {
    return std::ranges::find(kDealtFirst, kind->id) - kDealtFirst.begin();
  });
  return kinds;
}

void shuffle(std::vector<const EffectKind*>& kinds, Rng& rng) {
  for (std::size_t i = kinds.size(); i > 1; --i) std::swap(kinds[i - 1], kinds[rng.below(i)]);
}

/// Deals all kinds in random order, then again in another, for as long as asked.
class Deck {
 public:
  Deck(bool in_catalogue, Rng& rng) : kinds_(kinds_in_catalogue(in_catalogue)), rng_(rng) {}

  const EffectKind* deal() {
    if (next_ == 0) shuffle(kinds_, rng_);
    const EffectKind* kind = kinds_[next_];
    next_ = (next_ + 1) % kinds_.size();
    return kind;
  }

 private:
  std::vector<const EffectKind*> kinds_;
  Rng& rng_;
  std::size_t next_ = 0;
};

Utility draw_meter(const EffectKind& kind, const Drawings& drawings, Rng& rng) {
  const std::vector<MeterPlate> plates = plates_of(drawings);
  const Utility drawn = plates[rng.below(plates.size())].utility;
  const bool current_transformers = kind.id == "phase_lost";
  return current_transformers ? Utility::electricity : drawn;
}

/// Dates in the middle of the period, so that there is a before and an after.
HiddenChoice draw_choice(const EffectKind& kind, const Scenario& scenario, Rng& rng) {
  const sys_days first{std::chrono::year{scenario.period.start_year} / 1 / 1};
  const double length_days = 365.25 * scenario.period.years;
  const auto begin = first + days{static_cast<int>(length_days * rng.uniform(0.25, 0.6))};
  const auto length = days{static_cast<int>(rng.uniform(50.0, 200.0))};
  const bool negative = rng.uniform() < 0.5;
  const Utility meter = draw_meter(kind, scenario.drawings, rng);
  HiddenChoice choice{
      .kind = &kind, .strength = kind.strength.max, .from = {}, .to = {}, .meter = {}};
  if (negative && kind.strength.min < 0.0) choice.strength = kind.strength.min;
  if (kind.dated) choice.from = begin;
  if (kind.id == "vacancy") choice.to = begin + length;
  if (kind.of_one_meter) choice.meter = meter;
  return choice;
}

struct Hidden {
  Block block;
  std::vector<const EffectKind*> kinds;  ///< To be there together.
  double target = kPlain;                ///< d* of each.
  std::optional<Decoy> decoy;
};

std::vector<EffectNeeds> needs_of(const std::vector<const EffectKind*>& kinds) {
  std::vector<EffectNeeds> needs;
  for (const EffectKind* kind : kinds) needs.push_back(kind->needs);
  return needs;
}

/// The effect itself, then others of the same block that the building could have as well.
std::vector<HiddenChoice> with_stand_ins(const EffectKind& kind, const Scenario& scenario,
                                         Rng& rng) {
  const bool in_catalogue = kind.group != EffectClass::outside_catalogue;
  std::vector<const EffectKind*> others = kinds_in_catalogue(in_catalogue);
  shuffle(others, rng);
  std::vector<HiddenChoice> candidates{draw_choice(kind, scenario, rng)};
  for (const EffectKind* other : others) {
    Scenario alone = scenario;
    alone.effects = {draw_choice(*other, scenario, rng)};
    if (other == &kind || !check_effects(alone)) continue;
    candidates.push_back(alone.effects.front());
    if (candidates.size() > kStandIns) break;
  }
  return candidates;
}

Period draw_period(int years, Rng& rng) { return {2012 + static_cast<int>(rng.below(18)), years}; }

CasePlan plan_case(const PopulationKind& kind, std::uint64_t population_seed, std::size_t index,
                   const Hidden& hidden) {
  Rng rng{population_seed, static_cast<std::uint64_t>(Chance::cases) + index};
  CasePlan plan;
  plan.id = fmt::format("{}-{:03}", kind.name, index + 1);
  plan.block = hidden.block;
  plan.seed = rng.below(std::uint64_t{1} << 53U);
  Scenario& scenario = plan.scenario;
  scenario.drawings = draw_building(needs_of(hidden.kinds), rng);
  scenario.drawings.id = plan.id;
  scenario.period = draw_period(kind.years, rng);
  scenario.step = kInterval;
  const bool gaps = rng.uniform() < 1.0 / 3.0;
  scenario.care = gaps ? MeterCare::gaps : MeterCare::perfect;
  if (hidden.decoy) scenario.decoys.push_back(*hidden.decoy);
  plan.as_believed = misremembered(scenario.drawings, rng);
  for (const EffectKind* effect : hidden.kinds) {
    plan.wanted.push_back({with_stand_ins(*effect, scenario, rng), hidden.target});
  }
  return plan;
}

CasePlan plan_plain_case(std::uint64_t population_seed, std::size_t index, Use use) {
  Rng rng{population_seed, static_cast<std::uint64_t>(Chance::cases) + index};
  CasePlan plan;
  plan.id = fmt::format("plain-{:03}", index + 1);
  plan.block = Block::no_effect;
  plan.seed = rng.below(std::uint64_t{1} << 53U);
  Scenario& scenario = plan.scenario;
  scenario.drawings = draw_building_of(use, rng);
  scenario.drawings.id = plan.id;
  scenario.period = draw_period(3, rng);
  scenario.step = kInterval;
  scenario.care = MeterCare::usual;
  plan.as_believed = misremembered(scenario.drawings, rng);
  return plan;
}

bool can_stand_together(const EffectKind& one, const EffectKind& other) {
  const bool plants_clash = (one.needs.heat_pump && (other.needs.fuel || other.needs.heat_meter)) ||
                            (other.needs.heat_pump && (one.needs.fuel || one.needs.heat_meter));
  return &one != &other && one.turns != other.turns && !plants_clash;
}

/// Half of the pairs from one class, as the likeliest to be taken for each other.
Hidden draw_pair(bool same_class, Deck& deck) {
  for (;;) {
    const EffectKind* one = deck.deal();
    for (int attempt = 0; attempt < 60; ++attempt) {
      const EffectKind* other = deck.deal();
      const bool wanted = (one->group == other->group) == same_class;
      if (wanted && can_stand_together(*one, *other))
        return {Block::pair, {one, other}, kInPair, {}};
    }
  }
}

std::vector<Hidden> deal_blocks(const BlockSizes& sizes, Rng& rng) {
  Deck known(true, rng);
  Deck unknown(false, rng);
  std::vector<Hidden> all;
  for (int i = 0; i < sizes.no_effect; ++i) all.push_back({Block::no_effect, {}, kPlain, {}});
  for (const Singles& singles : sizes.singles) {
    for (int i = 0; i < singles.count; ++i) {
      all.push_back({Block::single, {known.deal()}, singles.detectability, {}});
    }
  }
  // One in five hides nothing but offers a driver that causes nothing.
  for (int i = 0; i < sizes.out_of_catalogue; ++i) {
    if (i % 5 == 4) {
      const Decoy decoy = i % 2 == 0 ? Decoy::wind_of_another_year : Decoy::neighbour_meter;
      all.push_back({Block::out_of_catalogue, {}, kPlain, decoy});
    } else {
      const double target = i % 2 == 0 ? kStrong : kPlain;
      all.push_back({Block::out_of_catalogue, {unknown.deal()}, target, {}});
    }
  }
  for (int i = 0; i < sizes.pairs; ++i) all.push_back(draw_pair(i % 2 == 0, known));
  // The order must not tell the block.
  for (std::size_t i = all.size(); i > 1; --i) std::swap(all[i - 1], all[rng.below(i)]);
  return all;
}

}  // namespace

Result<PopulationKind> population_kind(std::string_view name) {
  if (name == "smoke") {
    return PopulationKind{"smoke", {3, {{kPlain, 3}, {kStrong, 2}}, 2, 2}, 1};
  }
  if (name == "training") {
    const std::vector<Singles> singles{{2.0, 25}, {4.0, 25}, {kPlain, 25}, {kStrong, 25}};
    return PopulationKind{"training", {60, singles, 20, 20}, 3};
  }
  if (name == "sealed") {
    return PopulationKind{"sealed", {60, {{kPlain, 60}, {kStrong, 40}}, 20, 20}, 3};
  }
  return failure(
      ErrorCode::not_found,
      fmt::format("unknown population {}; there are smoke, training, sealed and plain", name));
}

Result<std::vector<Use>> uses_named(const std::vector<std::string>& names) {
  if (names.empty()) {
    return failure(ErrorCode::not_enough_data, "no use is given; such as --uses office,school");
  }
  std::vector<Use> uses;
  for (const std::string& name : names) {
    const auto found = std::ranges::find_if(kUses, [&](Use use) { return to_string(use) == name; });
    if (found == kUses.end()) {
      std::string list;
      for (const Use use : kUses) list += (list.empty() ? "" : ", ") + std::string(to_string(use));
      return failure(ErrorCode::not_found, fmt::format("unknown use {}; there are {}", name, list));
    }
    uses.push_back(*found);
  }
  std::ranges::sort(uses);
  const auto twice = std::ranges::unique(uses);
  uses.erase(twice.begin(), twice.end());
  return uses;
}

std::vector<CasePlan> plan_plain(const std::vector<Use>& uses, std::size_t count,
                                 std::uint64_t seed) {
  std::string name = "plain";
  for (const Use use : uses) name += " " + std::string(to_string(use));
  const std::uint64_t own = seed_of(name, seed);
  std::vector<CasePlan> plans;
  for (std::size_t i = 0; i < count; ++i) {
    plans.push_back(plan_plain_case(own, i, uses[i % uses.size()]));
  }
  return plans;
}

std::vector<CasePlan> plan_population(const PopulationKind& kind, std::uint64_t seed) {
  const std::uint64_t own = seed_of(kind.name, seed);
  Rng rng{own, static_cast<std::uint64_t>(Chance::order)};
  const std::vector<Hidden> hidden = deal_blocks(kind.sizes, rng);
  std::vector<CasePlan> plans;
  for (std::size_t i = 0; i < hidden.size(); ++i) {
    plans.push_back(plan_case(kind, own, i, hidden[i]));
  }
  return plans;
}

}  // namespace recald::blind
