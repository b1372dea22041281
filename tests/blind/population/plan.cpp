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

constexpr int kStandIns = 12;

/// Streams of one population's seed. A case's own numbers come from its index.
enum class Chance : std::uint64_t { order = 1, cases = 1'000 };

std::vector<const EffectKind*> kinds_in_catalogue(bool in_catalogue) {
  std::vector<const EffectKind*> kinds;
  for (const EffectKind& kind : effect_kinds()) {
    if (kind.group == EffectClass::operators) continue;  // a base parameter's, no effect is missing
    if ((kind.group != EffectClass::outside_catalogue) == in_catalogue) kinds.push_back(&kind);
  }
  return kinds;
}

void shuffle(std::vector<const EffectKind*>& kinds, Rng& rng) {
  for (std::size_t i = kinds.size(); i > 1; --i) std::swap(kinds[i - 1], kinds[rng.below(i)]);
}

/// Deals all kinds in random order, then again in another, for as long as asked. A kind that a
/// building cannot have waits for the next one.
class Deck {
 public:
  Deck(bool in_catalogue, Rng& rng) : kinds_(kinds_in_catalogue(in_catalogue)), rng_(rng) {}

  template <class Possible>
  const EffectKind* deal(const Possible& possible) {
    for (int round = 0; round < 2; ++round) {
      const auto found =
          std::ranges::find_if(waiting_, [&](const EffectKind* kind) { return possible(*kind); });
      if (found != waiting_.end()) {
        const EffectKind* const kind = *found;
        waiting_.erase(found);
        return kind;
      }
      shuffle(kinds_, rng_);
      waiting_.insert(waiting_.end(), kinds_.begin(), kinds_.end());
    }
    return nullptr;
  }

 private:
  std::vector<const EffectKind*> kinds_;
  Rng& rng_;
  std::vector<const EffectKind*> waiting_;
};

Utility draw_meter(const EffectKind& kind, const Drawings& drawings, Rng& rng) {
  const std::vector<MeterPlate> plates = plates_of(drawings);
  const Utility drawn = plates[rng.below(plates.size())].utility;
  const bool current_transformers = kind.id == "phase_lost";
  return current_transformers ? Utility::electricity : drawn;
}

/// In the middle of the period, so that there is a before and an after; or in its last year, which
/// is forecast.
struct Begin {
  sys_days day;
  bool is_in_last_year;
};

Begin draw_begin(const Period& period, Rng& rng) {
  constexpr double kInForecastYear = 0.25;
  const sys_days first{std::chrono::year{period.start_year} / 1 / 1};
  const bool last = period.years > 1 && rng.uniform() < kInForecastYear;
  const double share = last ? 1.0 - rng.uniform(0.4, 0.98) / period.years : rng.uniform(0.25, 0.6);
  return {first + days{static_cast<int>(365.25 * period.years * share)}, last};
}

HiddenChoice draw_choice(const EffectKind& kind, const Scenario& scenario, const Begin& begin,
                         Rng& rng) {
  const auto length = days{static_cast<int>(rng.uniform(50.0, 200.0))};
  const bool negative = rng.uniform() < 0.5;
  const Utility meter = draw_meter(kind, scenario.drawings, rng);
  HiddenChoice choice{
      .kind = &kind, .strength = kind.strength.max, .from = {}, .to = {}, .meter = {}};
  if (negative && kind.strength.min < 0.0) choice.strength = kind.strength.min;
  if (kind.dated || begin.is_in_last_year) choice.from = begin.day;
  if (kind.id == "vacancy") choice.to = begin.day + length;
  if (kind.of_one_meter) choice.meter = meter;
  return choice;
}

/// What a case is to hide.
struct Slot {
  Block block;
  ShareBin share = kAbove3;
  bool of_one_class = false;  ///< A pair's.
  std::optional<Decoy> decoy = {};
};

/// Whether the building can have it, beside what it has.
bool can_have(const Scenario& scenario, const HiddenChoice& choice) {
  Scenario with = scenario;
  with.effects.push_back(choice);
  return check_effects(with).has_value();
}

/// The effect itself, then others of the same block that the building could have as well.
std::vector<HiddenChoice> with_stand_ins(const HiddenChoice& first, const Scenario& scenario,
                                         const Begin& begin, Rng& rng) {
  const bool in_catalogue = first.kind->group != EffectClass::outside_catalogue;
  std::vector<const EffectKind*> others = kinds_in_catalogue(in_catalogue);
  shuffle(others, rng);
  std::vector<HiddenChoice> candidates{first};
  for (const EffectKind* other : others) {
    const HiddenChoice choice = draw_choice(*other, scenario, begin, rng);
    if (other == first.kind || !can_have(scenario, choice)) continue;
    candidates.push_back(choice);
    if (candidates.size() > kStandIns) break;
  }
  return candidates;
}

Period draw_period(int years, Rng& rng) { return {2012 + static_cast<int>(rng.below(18)), years}; }

/// A building of the family, drawn before anybody knows what it will hide: what is hidden must not
/// show in what is built.
CasePlan plan_building(const PopulationKind& kind, std::uint64_t population_seed, std::size_t index,
                       const Slot& slot, Rng& rng) {
  CasePlan plan;
  plan.id = fmt::format("{}-{:03}", kind.name, index + 1);
  plan.block = slot.block;
  rng = Rng{population_seed, static_cast<std::uint64_t>(Chance::cases) + index};
  plan.seed = rng.below(std::uint64_t{1} << 53U);
  Scenario& scenario = plan.scenario;
  const auto uses = uses_of(kind.family);
  scenario.drawings = draw_building_of(uses[rng.below(uses.size())], rng);
  scenario.drawings.id = plan.id;
  scenario.period = draw_period(kind.years, rng);
  scenario.step = kInterval;
  const bool gaps = rng.uniform() < 1.0 / 3.0;
  scenario.care = gaps ? MeterCare::gaps : MeterCare::perfect;
  if (slot.decoy) scenario.decoys.push_back(*slot.decoy);
  plan.as_believed = misremembered(scenario.drawings, rng);
  return plan;
}

/// Half of the pairs from one class, as the likeliest to be taken for each other.
void want(CasePlan& plan, const Slot& slot, Deck& deck, Rng& rng) {
  const Begin begin = draw_begin(plan.scenario.period, rng);
  Scenario with = plan.scenario;
  const std::size_t count = slot.block == Block::pair ? 2 : 1;
  while (plan.wanted.size() < count) {
    const auto fits = [&](const EffectKind& kind, bool any_class) {
      Rng tried = rng;
      const bool same = !with.effects.empty() && kind.group == with.effects.front().kind->group;
      const bool is_wanted = with.effects.empty() || any_class || same == slot.of_one_class;
      return is_wanted && can_have(with, draw_choice(kind, with, begin, tried));
    };
    const EffectKind* kind = deck.deal([&](const EffectKind& one) { return fits(one, false); });
    if (kind == nullptr) kind = deck.deal([&](const EffectKind& one) { return fits(one, true); });
    const HiddenChoice choice = draw_choice(*kind, with, begin, rng);
    plan.wanted.push_back({with_stand_ins(choice, with, begin, rng), slot.share});
    with.effects.push_back(choice);
  }
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

std::vector<Slot> slots_of(const PopulationKind& kind, Rng& rng) {
  std::vector<Slot> all(static_cast<std::size_t>(kind.no_effect), {Block::no_effect});
  for (const Singles& singles : kind.singles) {
    all.insert(all.end(), static_cast<std::size_t>(singles.count), {Block::single, singles.share});
  }
  // One in five hides nothing but offers a driver that causes nothing.
  for (int i = 0; i < kind.out_of_catalogue; ++i) {
    Slot slot{Block::out_of_catalogue};
    if (i % 5 == 4) {
      slot.decoy = i % 2 == 0 ? Decoy::wind_of_another_year : Decoy::neighbour_meter;
    }
    all.push_back(slot);
  }
  for (int i = 0; i < kind.pairs; ++i) all.push_back({Block::pair, kAbove3, i % 2 == 0});
  // The order must not tell the block.
  for (std::size_t i = all.size(); i > 1; --i) std::swap(all[i - 1], all[rng.below(i)]);
  return all;
}

}  // namespace

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
  const std::uint64_t own = own_seed(name, seed);
  std::vector<CasePlan> plans;
  for (std::size_t i = 0; i < count; ++i) {
    plans.push_back(plan_plain_case(own, i, uses[i % uses.size()]));
  }
  return plans;
}

std::vector<CasePlan> plan_population(const PopulationKind& kind, std::uint64_t seed) {
  const std::uint64_t own = own_seed(kind.name, seed);
  Rng order{own, static_cast<std::uint64_t>(Chance::order)};
  const std::vector<Slot> slots = slots_of(kind, order);
  Deck known(true, order);
  Deck unknown(false, order);
  std::vector<CasePlan> plans;
  for (std::size_t i = 0; i < slots.size(); ++i) {
    Rng rng{own, 0};
    plans.push_back(plan_building(kind, own, i, slots[i], rng));
    if (slots[i].block == Block::no_effect || slots[i].decoy) continue;
    want(plans.back(), slots[i], slots[i].block == Block::out_of_catalogue ? unknown : known, rng);
  }
  return plans;
}

}  // namespace recald::blind
