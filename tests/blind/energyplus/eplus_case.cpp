#include "tests/blind/energyplus/eplus_case.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>

#include "adapters/system/files/write_file.hpp"
#include "simulators/feed/feed_files.hpp"
#include "tests/blind/energyplus/foreign_building.hpp"
#include "tests/blind/population/moved_share.hpp"
#include "tests/blind/population/share_search.hpp"

namespace recald::blind {
namespace {

using namespace simulators;
using energyplus::HiddenChange;
using OrderedJson = nlohmann::ordered_json;
using std::chrono::days;
using std::chrono::sys_days;

/// Of the buildings to judge with, those that others wrote.
constexpr double kForeignShare = 0.5;

constexpr std::array kMeterEffects{"clock_offset", "dst_misapplied", "phase_lost", "scale_fault",
                                   "stuck_meter"};

const EffectKind& kind_of(std::string_view id) {
  const auto kinds = effect_kinds();
  return *std::ranges::find(kinds, id, &EffectKind::id);
}

bool is_in_catalogue(std::string_view id) {
  return kind_of(id).group != EffectClass::outside_catalogue;
}

std::vector<std::string> ids_in_catalogue(bool in_catalogue) {
  std::vector<std::string> kinds;
  for (const HiddenChange& change : energyplus::hidden_changes()) {
    if (is_in_catalogue(change.id) == in_catalogue) kinds.emplace_back(change.id);
  }
  if (in_catalogue) kinds.insert(kinds.end(), kMeterEffects.begin(), kMeterEffects.end());
  return kinds;
}

template <class T>
void shuffle(std::vector<T>& values, Rng& rng) {
  for (std::size_t i = values.size(); i > 1; --i) std::swap(values[i - 1], values[rng.below(i)]);
}

/// One effect in one building, whether in its model or in its meters.
struct Candidate {
  const EffectKind* kind;
  const HiddenChange* change;  ///< Null: in the meters.
  double least, most;          ///< Sizes of the strength; both have its sign.
  std::optional<metering::Day> from, to;
  std::optional<Utility> meter;

  /// Where the quantity is that of our own world, its words are too.
  [[nodiscard]] std::string_view unit() const {
    const bool has_own = change != nullptr && !change->unit.empty();
    return has_own ? change->unit : kind->strength.unit;
  }
};

/// Size and sign are drawn, and when it begins.
Candidate draw_candidate(const std::string& id, const EplusCasePlan& plan,
                         const SimulatedBuilding& building, Rng& rng) {
  constexpr double kFaintest = 0.02;  // Of what an engineer would call obvious.
  Candidate candidate{.kind = &kind_of(id), .change = energyplus::hidden_change(id)};
  const StrengthRange& range = candidate.kind->strength;
  const bool in_meters = candidate.change == nullptr;
  double low = in_meters ? range.min : candidate.change->least;
  double high = in_meters ? range.max : candidate.change->most;
  const bool negative = rng.uniform() < 0.5 && low < 0.0;
  if (negative) high = low;
  const bool is_whole =
      in_meters ? candidate.kind->all_or_nothing || id == "phase_lost" : low == high;
  candidate.most = high;
  candidate.least = is_whole ? high : low > 0.0 ? low : kFaintest * high;
  const sys_days first{std::chrono::year{plan.building.first_year} / 1 / 1};
  const double length_days = 365.25 * plan.building.years;
  const int years = plan.building.years;
  const double fitted = years == 1 ? 2.0 / 3.0 : (years - 1.0) / years;  // As the site file says.
  const double share = plan.begins_in_forecast_year ? 1.0 - rng.uniform(0.5, 0.98) * (1.0 - fitted)
                                                    : rng.uniform(0.25, 0.9) * fitted;
  const auto begin = first + days{static_cast<int>(length_days * share)};
  const auto length = days{static_cast<int>(rng.uniform(50.0, 200.0))};
  const bool dated = in_meters ? candidate.kind->dated : candidate.change->dated;
  if (dated || plan.begins_in_forecast_year) candidate.from = metering::Day{begin};
  if (!in_meters && candidate.change->course == energyplus::Course::for_a_while) {
    candidate.to = metering::Day{begin + length};
  }
  const auto& meters = building.meters();
  const Utility drawn = meters[rng.below(meters.size())].utility;
  if (candidate.kind->of_one_meter)
    candidate.meter = id == "phase_lost" ? Utility::electricity : drawn;
  return candidate;
}

/// What is hidden, as it came out.
struct Hidden {
  Candidate candidate;
  double strength;
  std::vector<double> share_of_meter;  ///< Signed, by meter.
  std::vector<double> moved_share;
  Loads loads;  ///< Before the meters.

  [[nodiscard]] double most_moved() const { return *std::ranges::max_element(moved_share); }
};

/// EnergyPlus does not simulate everything that can be drawn.
bool was_refused(const Error& error) { return error.code == ErrorCode::invalid_value; }

class Hider {
 public:
  Hider(const EplusCasePlan& plan, const SimulatedBuilding& building)
      : plan_(plan),
        building_(building),
        twin_(building.recording_of(building.twin())),
        blocks_(blocks_of(twin_, building.calendar())) {}

  /// @return nothing if no candidate can move a meter so much.
  Result<std::optional<Hidden>> hide(Rng rng) {
    for (const std::string& id : plan_.candidates) {
      const HiddenChange* const change = energyplus::hidden_change(id);
      const Candidate candidate = draw_candidate(id, plan_, building_, rng);
      if (change != nullptr && !building_.could_have(*change)) continue;
      auto hidden = at_share(candidate);
      const bool is_out = hidden ? !*hidden : was_refused(hidden.error());
      if (!is_out) return hidden;
      refused_.push_back(id);
    }
    return std::optional<Hidden>{};
  }

  [[nodiscard]] HiddenEffects in_meters(const Candidate& candidate, double strength) const {
    HiddenEffects effects;
    if (candidate.change != nullptr) return effects;
    effects.push_back(make(*candidate.kind,
                           {.strength = strength,
                            .from = candidate.from,
                            .to = candidate.to,
                            .meter = candidate.meter,
                            .calendar = &building_.calendar(),
                            .rng = stream_of(plan_.building.seed, Stream::effects)},
                           plan_.building.building.drawings));
    return effects;
  }

  [[nodiscard]] int years_run() const { return years_run_; }
  [[nodiscard]] const std::vector<std::string>& refused() const { return refused_; }

 private:
  Result<std::optional<Hidden>> at_share(const Candidate& candidate) {
    constexpr int kTries = 3;
    std::optional<Hidden> last;
    const auto strength = strength_in(plan_.wanted, {candidate.least, candidate.most}, kTries,
                                      [&](double tried) -> Result<double> {
                                        auto hidden = at(candidate, tried);
                                        if (!hidden) return tl::unexpected(hidden.error());
                                        last = std::move(*hidden);
                                        return last->most_moved();
                                      });
    if (!strength) return tl::unexpected(strength.error());
    if (!*strength) last.reset();
    return last;
  }

  Result<Hidden> at(const Candidate& candidate, double strength) {
    Hidden hidden{candidate, strength, {}, {}, building_.twin()};
    if (candidate.change != nullptr) {
      auto loads = building_.with({candidate.change, strength, candidate.from, candidate.to});
      if (!loads) return tl::unexpected(loads.error());
      hidden.loads = std::move(*loads);
      years_run_ += plan_.building.years;
    }
    const Recording with = building_.recording_of(hidden.loads);
    const HiddenEffects effects = in_meters(candidate, strength);
    std::vector<double> wholes_kW;
    for (std::size_t meter = 0; meter < building_.meters().size(); ++meter) {
      std::vector<double> footprint_kW =
          metered_kW(with, building_.meters()[meter].utility, effects, building_.calendar());
      double whole_kW = 0.0;
      double net_kW = 0.0;
      for (std::size_t slot = 0; slot < footprint_kW.size(); ++slot) {
        footprint_kW[slot] -= building_.twin()[meter][slot];
        whole_kW += building_.twin()[meter][slot];
        net_kW += footprint_kW[slot];
      }
      hidden.share_of_meter.push_back(whole_kW > 0.0 ? net_kW / whole_kW : 0.0);
      hidden.moved_share.push_back(moved_share(footprint_kW, blocks_, whole_kW));
      wholes_kW.push_back(whole_kW);
    }
    leave_out_small_meters(wholes_kW, hidden.moved_share);
    return hidden;
  }

  const EplusCasePlan& plan_;
  const SimulatedBuilding& building_;
  Recording twin_;
  std::vector<std::size_t> blocks_;
  int years_run_ = 0;
  std::vector<std::string> refused_;  ///< Could not move as much as wanted.
};

OrderedJson ordered_date_of(const std::optional<metering::Day>& day) {
  return day ? OrderedJson(metering::to_string(*day)) : OrderedJson(nullptr);
}

OrderedJson effects_json(const std::optional<Hidden>& hidden, const SimulatedBuilding& building) {
  OrderedJson list = OrderedJson::array();
  if (!hidden) return list;
  OrderedJson shares = OrderedJson::object();
  OrderedJson moved = OrderedJson::object();
  for (std::size_t meter = 0; meter < building.meters().size(); ++meter) {
    shares[building.meters()[meter].sum.id] = hidden->share_of_meter[meter];
    moved[building.meters()[meter].sum.id] = hidden->moved_share[meter];
  }
  const Candidate& candidate = hidden->candidate;
  list.push_back({{"effect", candidate.kind->id},
                  {"class", to_string(candidate.kind->group)},
                  {"in_catalogue", candidate.kind->group != EffectClass::outside_catalogue},
                  {"strength", hidden->strength},
                  {"unit", candidate.unit()},
                  {"from", ordered_date_of(candidate.from)},
                  {"to", ordered_date_of(candidate.to)},
                  {"share_of_meter", shares},
                  {"moved_share", moved}});
  return list;
}

OrderedJson answer_json(const EplusCasePlan& plan, const SimulatedBuilding& building,
                        const std::optional<Hidden>& hidden,
                        const std::vector<std::string>& refused) {
  const energyplus::TemplatedBuilding& built = plan.building.building;
  const std::optional<ForeignModel>& foreign = plan.building.foreign;
  OrderedJson answer{{"case", plan.building.id},
                     {"world", "energyplus"},
                     {"block", block_name(plan.block)},
                     {"grain", {{"detectability", nullptr}}},
                     {"effects", effects_json(hidden, building)},
                     {"decoys", OrderedJson::array()},
                     {"climate", name_of(built.drawings.climate)},
                     {"use", to_string(built.drawings.use)},
                     {"family", to_string(plan.family)},
                     {"shape", foreign ? "of others" : to_string(built.shape)},
                     {"system", foreign ? foreign->file : to_string(built.system)},
                     {"gaps", plan.care == MeterCare::gaps},
                     {"differs_from_drawings", building.truth()},
                     {"refused", refused}};
  add_base_parameters(answer, building.base_truth(), building.as_drawn());
  return answer;
}

}  // namespace

std::vector<EplusCasePlan> plan_eplus(const PopulationKind& population, std::uint64_t seed) {
  const std::uint64_t own = own_seed("energyplus " + population.name, seed);
  struct Slot {
    Block block;
    ShareBin wanted;
  };
  std::vector<Slot> slots(static_cast<std::size_t>(population.no_effect), {Block::no_effect, {}});
  for (const auto& [bin, count] : population.singles) {
    slots.insert(slots.end(), static_cast<std::size_t>(count), {Block::single, bin});
  }
  slots.insert(slots.end(), static_cast<std::size_t>(population.out_of_catalogue),
               {Block::out_of_catalogue, kAbove3});
  Rng order{own, 1};
  shuffle(slots, order);
  std::vector<std::string> known = ids_in_catalogue(true);
  std::vector<std::string> unknown = ids_in_catalogue(false);
  std::vector<EplusCasePlan> plans;
  std::size_t known_dealt = 0;
  std::size_t unknown_dealt = 0;
  for (std::size_t i = 0; i < slots.size(); ++i) {
    Rng rng{own, 1000 + i};
    EplusCasePlan plan{.building = {},
                       .family = population.family,
                       .block = slots[i].block,
                       .care = {},
                       .wanted = slots[i].wanted,
                       .candidates = {}};
    plan.building.id = fmt::format("{}-eplus-{:03}", population.name, i + 1);
    plan.building.seed = rng.below(std::uint64_t{1} << 53U);
    plan.building.building = draw_eplus_building(population.family, rng);
    if (population.family == Family::judging && rng.uniform() < kForeignShare) {
      plan.building.foreign = foreign_models()[rng.below(foreign_models().size())];
    }
    plan.building.building.drawings.id = plan.building.id;
    plan.building.first_year = 2013 + static_cast<int>(rng.below(14));
    plan.building.years = population.years;
    plan.care = rng.uniform() < 1.0 / 3.0 ? MeterCare::gaps : MeterCare::perfect;
    if (plan.block != Block::no_effect) {
      plan.begins_in_forecast_year = rng.uniform() < 0.25;
      const bool is_known = plan.block == Block::single;
      // Every kind is wanted once before any is wanted again, each time in a new order, or numbers
      // of cases would tell; the others stand by.
      std::vector<std::string>& kinds = is_known ? known : unknown;
      std::size_t& dealt = is_known ? known_dealt : unknown_dealt;
      if (dealt % kinds.size() == 0) shuffle(kinds, order);
      plan.candidates = kinds;
      std::swap(plan.candidates.front(), plan.candidates[dealt++ % plan.candidates.size()]);
      std::vector<std::string> others(plan.candidates.begin() + 1, plan.candidates.end());
      shuffle(others, rng);
      std::ranges::copy(others, plan.candidates.begin() + 1);
    }
    plans.push_back(std::move(plan));
  }
  return plans;
}

namespace {

/// What a user would have.
Result<void> write_feed(const std::filesystem::path& folder, const EplusCasePlan& plan,
                        const SimulatedBuilding& building, const Loads& loads,
                        const HiddenEffects& effects) {
  const Recording recording = building.recording_of(loads);
  const std::vector<MeterPlate> plates = building.plates();
  std::vector<MeterFeed> feeds;
  for (const MeterPlate& plate : plates) {
    feeds.push_back(
        read_meter(recording, plate, plan.care, plan.building.seed, effects, building.calendar()));
  }
  auto written = system::make_folder(folder);
  if (written)
    written = system::write_file(folder / "readings.csv", readings_csv(recording, feeds));
  if (written) written = system::write_file(folder / "weather.csv", building.weather_text());
  if (written) written = system::write_file(folder / "site.toml", building.site_text(plates));
  return written;
}

/// What the effects add to each meter, free of noise and gaps.
std::string footprint_text(const SimulatedBuilding& building, const Loads& loads,
                           const HiddenEffects& effects) {
  const Recording with = building.recording_of(loads);
  const Recording without = building.recording_of(building.twin());
  const std::vector<MeterPlate> plates = building.plates();
  std::vector<std::vector<double>> added_kW;
  for (const MeterPlate& plate : plates) {
    std::vector<double>& added =
        added_kW.emplace_back(metered_kW(with, plate.utility, effects, building.calendar()));
    for (std::size_t slot = 0; slot < added.size(); ++slot) {
      added[slot] -= without.power[slot][plate.utility];
    }
  }
  return footprint_csv(with, plates, added_kW);
}

/// The building as planned, or another draw of it where EnergyPlus refuses it; at last one of ours
/// in the place of one of others.
Result<SimulatedBuilding> make_building(EplusPlan& plan, const Engine& engine,
                                        const std::filesystem::path& scratch) {
  constexpr std::uint64_t kAttempts = 6;
  const std::uint64_t first = plan.seed;
  for (std::uint64_t attempt = 0;; ++attempt) {
    plan.seed = attempt == 0 ? first : Rng{first, attempt}.below(std::uint64_t{1} << 53U);
    if (attempt >= kAttempts / 2) plan.foreign = {};
    auto building = SimulatedBuilding::make(plan, engine, scratch);
    const bool is_settled = building || !was_refused(building.error());
    if (is_settled || attempt + 1 == kAttempts) return building;
    std::error_code whatever;  // What stays is overwritten.
    std::filesystem::remove_all(scratch, whatever);
  }
}

}  // namespace

Result<int> make_eplus_case(const EplusCasePlan& planned, const Engine& engine,
                            const std::filesystem::path& scratch, const CaseFolders& folders) {
  EplusCasePlan plan = planned;
  const std::string& id = plan.building.id;
  const auto building = make_building(plan.building, engine, scratch);
  if (!building) return tl::unexpected(building.error());
  Hider hider(plan, *building);
  std::optional<Hidden> hidden;
  if (plan.block != Block::no_effect) {
    auto found = hider.hide(stream_of(plan.building.seed, Stream::decoys));
    if (!found) return tl::unexpected(found.error());
    if (!*found) {
      return failure(
          ErrorCode::not_enough_data,
          fmt::format("nothing moves {:g} to {:g} % of a meter in this building; draw the "
                      "population with another --seed",
                      100.0 * plan.wanted.least, 100.0 * plan.wanted.most));
    }
    hidden = std::move(*found);
  }
  const Loads& loads = hidden ? hidden->loads : building->twin();
  const HiddenEffects effects =
      hidden ? hider.in_meters(hidden->candidate, hidden->strength) : HiddenEffects{};
  auto written = write_feed(folders.cases / id, plan, *building, loads, effects);
  if (written && !folders.twins.empty()) {
    const std::filesystem::path twin = folders.twins / id;
    written = write_feed(twin, plan, *building, building->twin(), {});
    if (written) {
      written =
          system::write_file(twin / "footprint.csv", footprint_text(*building, loads, effects));
    }
  }
  if (written) {
    written =
        system::write_file(folders.answers / (id + ".json"),
                           answer_json(plan, *building, hidden, hider.refused()).dump(1) + "\n");
  }
  std::error_code whatever;  // Files that stay cost room and nothing else.
  std::filesystem::remove_all(scratch, whatever);
  if (!written) return tl::unexpected(written.error());
  return plan.building.years + hider.years_run();
}

}  // namespace recald::blind
