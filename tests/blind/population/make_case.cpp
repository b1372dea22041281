#include "tests/blind/population/make_case.hpp"

#include <cmath>
#include <map>
#include <nlohmann/json.hpp>

#include "adapters/system/write_file.hpp"
#include "simulators/feed/feed_files.hpp"
#include "simulators/scenario/scenario_files.hpp"
#include "tests/blind/population/strength_search.hpp"

namespace recald::blind {
namespace {

using namespace simulators;
using Json = nlohmann::ordered_json;

/// What an effect does to each meter, as shares of the meter's own sum.
struct Shares {
  std::vector<double> signed_share;
  std::vector<double> moved_share;
  double largest = 0.0;  ///< As `moved_share`, of the meter that it moves most.
};

/// Interval to its month, kind of day and four hours of the day, counted through the year.
std::vector<std::size_t> blocks_of(const Recording& recording,
                                   const metering::LocalCalendar& calendar) {
  std::vector<std::size_t> blocks;
  for (std::size_t slot = 0; slot < recording.power.size(); ++slot) {
    const metering::LocalTime local = calendar.local_time(recording.start_of(slot));
    const auto month = static_cast<std::size_t>(static_cast<unsigned>(local.date.month())) - 1;
    const std::chrono::weekday weekday{std::chrono::sys_days{local.date}};
    const std::size_t weekend = weekday.iso_encoding() >= 6 ? 1 : 0;
    blocks.push_back((month * 2 + weekend) * 6 +
                     static_cast<std::size_t>(local.minute_of_day / 240));
  }
  return blocks;
}

/// Sum over blocks of |footprint| against the meter's sum. Within a block a thermostat that
/// switches some minutes later takes and gives back: that is no effect, and it grows with no
/// strength.
double moved_share(const std::vector<double>& footprint_kW, const std::vector<std::size_t>& blocks,
                   double whole_kW) {
  std::array<double, 144> sum_kW{};
  for (std::size_t slot = 0; slot < blocks.size(); ++slot)
    sum_kW[blocks[slot]] += footprint_kW[slot];
  double moved_kW = 0.0;
  for (const double block_kW : sum_kW) moved_kW += std::abs(block_kW);
  return whole_kW > 0.0 ? moved_kW / whole_kW : 0.0;
}

Shares shares_of(const std::vector<std::vector<double>>& footprint_kW, const Simulated& twin,
                 const std::vector<std::size_t>& blocks) {
  Shares shares;
  const std::vector<MeterPlate> plates = plates_of(twin.building.truth().drawings);
  for (std::size_t meter = 0; meter < plates.size(); ++meter) {
    double whole_kW = 0.0;
    double net_kW = 0.0;
    for (std::size_t slot = 0; slot < blocks.size(); ++slot) {
      whole_kW += twin.recording.power[slot][plates[meter].utility];
      net_kW += footprint_kW[meter][slot];
    }
    shares.signed_share.push_back(whole_kW > 0.0 ? net_kW / whole_kW : 0.0);
    shares.moved_share.push_back(moved_share(footprint_kW[meter], blocks, whole_kW));
    shares.largest = std::max(shares.largest, shares.moved_share.back());
  }
  return shares;
}

/// A phase is lost or it is not: what counts is that it shows at least as much as asked.
StrengthFound whole_effect(double target_share, double strength, const Visibility& visibility) {
  const double reached = visibility(strength);
  return {.strength = strength,
          .reached = reached,
          .attained = reached >= 0.95 * target_share,
          .evaluations = 1};
}

/// Settles one effect of a case after the other.
class Settler {
 public:
  Settler(const CasePlan& plan, const metering::LocalCalendar& calendar, const Simulated& twin)
      : plan_(plan),
        calendar_(calendar),
        twin_(twin),
        blocks_(blocks_of(twin.recording, calendar)) {
    settled_.scenario = plan.scenario;
    settled_.simulations = 1;
  }

  void settle(const Wanted& wanted) {
    std::optional<HiddenAtStrength> best;
    for (const HiddenChoice& candidate : wanted.candidates) {
      Scenario together = settled_.scenario;
      together.effects.push_back(candidate);
      if (!check_effects(together)) continue;
      HiddenAtStrength tried = search(candidate, wanted.target_share);
      const bool better = !best || tried.reached_share > best->reached_share;
      if (tried.attained || better) best = std::move(tried);
      if (best->attained) break;
      settled_.refused.emplace_back(candidate.kind->id);
    }
    // Less than half of what was asked would be another block's case.
    if (!best || best->reached_share < 0.5 * wanted.target_share) {
      missed_ = wanted.candidates.front().kind->id;
      return;
    }
    settled_.scenario.effects.push_back(best->choice);
    settled_.effects.push_back(std::move(*best));
  }

  /// @return not_enough_data where neither an effect nor a stand-in shows enough
  [[nodiscard]] Result<SettledCase> result() && {
    if (missed_.empty()) return std::move(settled_);
    return failure(ErrorCode::not_enough_data,
                   plan_.id + ": nothing like " + missed_ +
                       " shows enough in this building; draw the population with another --seed");
  }

 private:
  HiddenAtStrength search(const HiddenChoice& candidate, double target_share) {
    std::map<double, Shares> seen;
    const auto visibility = [&](double strength) {
      const Shares shares = try_out(candidate, strength);
      return seen.emplace(strength, shares).first->second.largest;
    };
    const StrengthFound found =
        candidate.kind->all_or_nothing
            ? whole_effect(target_share, candidate.kind->strength.typical, visibility)
            : strength_for(target_share, candidate.strength, visibility);
    HiddenAtStrength result{.choice = candidate,
                            .target_share = target_share,
                            .reached_share = found.reached,
                            .attained = found.attained,
                            .share_of_meter = seen.at(found.strength).signed_share,
                            .moved_share = seen.at(found.strength).moved_share};
    result.choice.strength = found.strength;
    return result;
  }

  Shares try_out(HiddenChoice choice, double strength) {
    choice.strength = strength;
    Scenario alone = plan_.scenario;
    alone.effects = {choice};
    const auto with = simulate(alone, plan_.seed, calendar_);
    ++settled_.simulations;
    return shares_of(footprint_kW(*with, twin_, calendar_), twin_, blocks_);
  }

  const CasePlan& plan_;
  const metering::LocalCalendar& calendar_;
  const Simulated& twin_;
  std::vector<std::size_t> blocks_;
  SettledCase settled_;
  std::string missed_;
};

Json date_of(const std::optional<metering::Day>& day) {
  return day ? Json(metering::to_string(*day)) : Json(nullptr);
}

Json effects_json(const SettledCase& settled) {
  const std::vector<MeterPlate> plates = plates_of(settled.scenario.drawings);
  Json list = Json::array();
  for (const HiddenAtStrength& hidden : settled.effects) {
    Json shares = Json::object();
    Json moved = Json::object();
    for (std::size_t meter = 0; meter < plates.size(); ++meter) {
      shares[std::string(plates[meter].id)] = hidden.share_of_meter[meter];
      moved[std::string(plates[meter].id)] = hidden.moved_share[meter];
    }
    const EffectKind& kind = *hidden.choice.kind;
    list.push_back({{"effect", kind.id},
                    {"class", to_string(kind.group)},
                    {"in_catalogue", kind.group != EffectClass::outside_catalogue},
                    {"strength", hidden.choice.strength},
                    {"unit", kind.strength.unit},
                    {"from", date_of(hidden.choice.from)},
                    {"to", date_of(hidden.choice.to)},
                    {"share_of_meter", shares},
                    {"moved_share", moved},
                    {"target_share", hidden.target_share},
                    {"reached_share", hidden.reached_share},
                    {"attained", hidden.attained}});
  }
  return list;
}

/// Standard deviation of Triangular(min, mode, max).
double triangular_sd(double min, double mode, double max) {
  return std::sqrt((min * min + mode * mode + max * max - min * mode - min * max - mode * max) /
                   18.0);
}

Json answer_json(const CasePlan& plan, const SettledCase& settled, const Truth& truth) {
  const Drawings& drawings = truth.drawings;
  Json decoys = Json::array();
  for (const Decoy decoy : settled.scenario.decoys) decoys.push_back(to_string(decoy));
  const double people = drawings.occupancy_person_m2;
  const double air_m3_s = drawings.outdoor_air_m3_s();
  return {{"case", plan.id},
          {"block", block_name(plan.block)},
          {"grain", {{"detectability", nullptr}}},
          {"effects", effects_json(settled)},
          {"decoys", decoys},
          {"climate", name_of(drawings.climate)},
          {"use", to_string(drawings.use)},
          {"gaps", settled.scenario.care == MeterCare::gaps},
          {"true_parameters",
           {{"occupancy_density", truth.occupancy_density_person_m2},
            {"outdoor_airflow", truth.outdoor_airflow_m3_s},
            {"cooling_setpoint", truth.cooling_setpoint_C}}},
          {"prior_sd",
           {{"occupancy_density", triangular_sd(0.0, people, 2.0 * people)},
            {"outdoor_airflow", triangular_sd(0.3 * air_m3_s, air_m3_s, 1.2 * air_m3_s)},
            {"cooling_setpoint", triangular_sd(20.0, drawings.cooling_setpoint_C, 27.8)}}},
          {"refused", settled.refused}};
}

Scenario with_believed(Scenario scenario, const Drawings& believed) {
  scenario.drawings = believed;
  return scenario;
}

/// readings.csv, weather.csv and site.toml: what a user would have.
Result<void> write_feed(const std::filesystem::path& folder, const CasePlan& plan,
                        const Scenario& scenario, const Simulated& simulated,
                        const metering::LocalCalendar& calendar) {
  const Feeds feeds = read_feeds(scenario, plan.seed, simulated, calendar);
  if (const auto made = system::make_folder(folder); !made) return made;
  auto written =
      system::write_file(folder / "readings.csv", readings_csv(simulated.recording, feeds.meters));
  if (!written) return written;
  written =
      system::write_file(folder / "weather.csv", weather_csv(simulated.recording, feeds.weather));
  if (!written) return written;
  return system::write_file(folder / "site.toml",
                            site_toml(with_believed(scenario, plan.as_believed)));
}

Result<void> write_twin(const std::filesystem::path& folder, const CasePlan& plan,
                        const Scenario& scenario, const Simulated& with,
                        const metering::LocalCalendar& calendar) {
  const Scenario twin = twin_of(scenario);
  const auto without = simulate(twin, plan.seed, calendar);
  if (!without) return tl::unexpected(without.error());
  if (const auto written = write_feed(folder, plan, twin, *without, calendar); !written) {
    return written;
  }
  return system::write_file(folder / "footprint.csv",
                            footprint_csv(with.recording, plates_of(scenario.drawings),
                                          footprint_kW(with, *without, calendar)));
}

}  // namespace

Result<SettledCase> settle(const CasePlan& plan) {
  const auto calendar = metering::LocalCalendar::open(plan.scenario.drawings.time_zone);
  if (!calendar) return tl::unexpected(calendar.error());
  if (plan.wanted.empty()) {
    SettledCase plain;
    plain.scenario = plan.scenario;
    return plain;
  }
  const auto twin = simulate(plan.scenario, plan.seed, *calendar);
  if (!twin) return tl::unexpected(twin.error());
  Settler settler(plan, *calendar, *twin);
  for (const Wanted& wanted : plan.wanted) settler.settle(wanted);
  return std::move(settler).result();
}

Result<void> write_case(const CasePlan& plan, const SettledCase& settled,
                        const CaseFolders& folders) {
  const auto calendar = metering::LocalCalendar::open(plan.scenario.drawings.time_zone);
  if (!calendar) return tl::unexpected(calendar.error());
  const Scenario& scenario = settled.scenario;
  const auto with = simulate(scenario, plan.seed, *calendar);
  if (!with) return tl::unexpected(with.error());
  auto written = write_feed(folders.cases / plan.id, plan, scenario, *with, *calendar);
  if (written && !folders.twins.empty()) {
    written = write_twin(folders.twins / plan.id, plan, scenario, *with, *calendar);
  }
  if (!written) return written;
  // The answer's truth is that of the drawings; what an effect rebuilt is the effect.
  const Truth truth = draw_truth(scenario.drawings, plan.seed);
  return system::write_file(folders.answers / (plan.id + ".json"),
                            answer_json(plan, settled, truth).dump(1) + "\n");
}

}  // namespace recald::blind
