#include "tests/blind/population/make_case.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "adapters/system/files/write_file.hpp"
#include "simulators/feed/feed_files.hpp"
#include "simulators/scenario/scenario_files.hpp"
#include "tests/blind/population/base_parameters.hpp"
#include "tests/blind/population/moved_share.hpp"
#include "tests/blind/population/share_search.hpp"

namespace recald::blind {
namespace {

using namespace simulators;
using Json = nlohmann::ordered_json;

/// What an effect does to each meter, as shares of the meter's own sum.
struct Footprint {
  std::vector<double> signed_share;
  std::vector<double> moved_share;
};

Footprint shares_of(const std::vector<std::vector<double>>& footprint_kW, const Simulated& twin,
                    const std::vector<MeterPlate>& plates, const std::vector<std::size_t>& blocks) {
  Footprint shares;
  std::vector<double> wholes_kW;
  for (std::size_t meter = 0; meter < plates.size(); ++meter) {
    double whole_kW = 0.0;
    double net_kW = 0.0;
    for (std::size_t slot = 0; slot < blocks.size(); ++slot) {
      whole_kW += twin.recording.power[slot][plates[meter].utility];
      net_kW += footprint_kW[meter][slot];
    }
    shares.signed_share.push_back(whole_kW > 0.0 ? net_kW / whole_kW : 0.0);
    shares.moved_share.push_back(moved_share(footprint_kW[meter], blocks, whole_kW));
    wholes_kW.push_back(whole_kW);
  }
  leave_out_small_meters(wholes_kW, shares.moved_share);
  return shares;
}

/// A building without effects, ready to be compared with itself.
struct Plain {
  Scenario scenario;
  Simulated twin;
};

Result<Plain> run_plain(Scenario scenario, std::uint64_t seed,
                        const metering::LocalCalendar& calendar) {
  auto twin = simulate(scenario, seed, calendar);
  if (!twin) return tl::unexpected(twin.error());
  return Plain{std::move(scenario), std::move(*twin)};
}

/// Settles one effect of a case after the other.
class Settler {
 public:
  Settler(const CasePlan& plan, const metering::LocalCalendar& calendar, const Plain& plain)
      : plan_(plan),
        calendar_(calendar),
        plain_(plain),
        plates_(plates_of(plain.twin.building.truth().drawings)),
        blocks_(blocks_of(plain.twin.recording, calendar)) {
    settled_.scenario = plan.scenario;
    settled_.simulations = 1;
  }

  Result<void> settle(const Wanted& wanted) {
    for (const HiddenChoice& candidate : wanted.candidates) {
      Scenario together = settled_.scenario;
      together.effects.push_back(candidate);
      if (!check_effects(together)) continue;
      auto found = search(candidate, wanted.share);
      if (!found) return tl::unexpected(found.error());
      if (*found) {
        settled_.scenario.effects.push_back((*found)->choice);
        settled_.effects.push_back(std::move(**found));
        return {};
      }
      settled_.refused.emplace_back(candidate.kind->id);
    }
    return failure(ErrorCode::not_enough_data,
                   fmt::format("{}: nothing like {} moves {:g} to {:g} % of a meter in this "
                               "building; draw the population with another --seed",
                               plan_.id, wanted.candidates.front().kind->id,
                               100.0 * wanted.share.least, 100.0 * wanted.share.most));
  }

  [[nodiscard]] SettledCase result() && { return std::move(settled_); }

 private:
  /// The effect as strong as asked; nothing where no strength is.
  Result<std::optional<HiddenAtStrength>> search(const HiddenChoice& candidate,
                                                 const ShareBin& share) {
    constexpr double kFaintest = 0.005;  // Of the strongest.
    constexpr int kTries = 6;
    const StrengthRange& range = candidate.kind->strength;
    const bool is_whole = candidate.kind->all_or_nothing || candidate.kind->id == "phase_lost";
    const double most = is_whole ? range.typical : candidate.strength;
    std::optional<Footprint> last;
    const auto strength = strength_in(share, {is_whole ? most : kFaintest * most, most}, kTries,
                                      [&](double tried) -> Result<double> {
                                        auto footprint = try_out(candidate, tried);
                                        if (!footprint) return tl::unexpected(footprint.error());
                                        last = std::move(*footprint);
                                        return *std::ranges::max_element(last->moved_share);
                                      });
    if (!strength) return tl::unexpected(strength.error());
    if (!*strength) return std::nullopt;
    HiddenAtStrength result{.choice = candidate,
                            .share_of_meter = std::move(last->signed_share),
                            .moved_share = std::move(last->moved_share)};
    result.choice.strength = **strength;
    return result;
  }

  Result<Footprint> try_out(HiddenChoice choice, double strength) {
    choice.strength = strength;
    Scenario alone = plain_.scenario;
    alone.effects = {choice};
    const auto with = simulate(alone, plan_.seed, calendar_);
    if (!with) return tl::unexpected(with.error());
    ++settled_.simulations;
    return shares_of(footprint_kW(*with, plain_.twin, calendar_), plain_.twin, plates_, blocks_);
  }

  const CasePlan& plan_;
  const metering::LocalCalendar& calendar_;
  const Plain& plain_;
  std::vector<MeterPlate> plates_;
  std::vector<std::size_t> blocks_;
  SettledCase settled_;
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
                    {"moved_share", moved}});
  }
  return list;
}

Json answer_json(const CasePlan& plan, const SettledCase& settled, const Truth& truth) {
  const Drawings& drawings = truth.drawings;
  Json decoys = Json::array();
  for (const Decoy decoy : settled.scenario.decoys) decoys.push_back(to_string(decoy));
  Json answer{{"case", plan.id},
              {"block", block_name(plan.block)},
              {"effects", effects_json(settled)},
              {"decoys", decoys},
              {"climate", name_of(drawings.climate)},
              {"use", to_string(drawings.use)},
              {"gaps", settled.scenario.care == MeterCare::gaps},
              {"refused", settled.refused}};
  add_base_parameters(
      answer,
      {truth.occupancy_density_person_m2, truth.outdoor_airflow_m3_s, truth.cooling_setpoint_C},
      {drawings.occupancy_person_m2, drawings.outdoor_air_m3_s(), drawings.cooling_setpoint_C});
  return answer;
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
  const auto plain = run_plain(plan.scenario, plan.seed, *calendar);
  if (!plain) return tl::unexpected(plain.error());
  Settler settler(plan, *calendar, *plain);
  for (const Wanted& wanted : plan.wanted) {
    if (auto settled = settler.settle(wanted); !settled) return tl::unexpected(settled.error());
  }
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
