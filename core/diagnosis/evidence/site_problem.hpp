/// Everything that a diagnosis knows about a site: its drawings, their uncertainty, its
/// drivers and its meters.
#pragma once

#include <Eigen/Core>
#include <array>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "core/diagnosis/effects/support/effect.hpp"
#include "core/diagnosis/evidence/day_parts.hpp"
#include "core/display/unit.hpp"
#include "core/executor.hpp"
#include "core/model/end_use.hpp"
#include "core/model/hourly/hourly.hpp"
#include "core/model/parameter_library.hpp"

namespace recald::diagnosis {

struct MeterData {
  std::string id;
  metering::Utility utility;
  model::MeterMap end_uses;
  std::optional<double> price_per_kWh{};  ///< Mean over its consumption; in the site's currency.
  std::optional<double> emissions_kg_per_kWh{};  ///< CO2.
};

struct SiteProblem {
  model::Building nominal;
  std::vector<Parameter> parameters;  ///< (q) with their original priors.
  model::ElectricLoads loads;         ///< Lights and plugs of the drivers.
  std::shared_ptr<const model::Drivers> drivers;
  bool has_sun = true;            ///< False: it was assumed, and nothing may be concluded from it.
  std::vector<MeterData> meters;  ///< (m)
  std::string currency;           ///< Of their prices.
  display::UnitSystem units = display::UnitSystem::si;  ///< Of words.
  Eigen::ArrayXXd measured_kW;                          ///< (hours x m) NaN where not measured.
  DayParts day_parts;
  Eigen::ArrayXXd measured_parts_kW;  ///< (parts x m) NaN where too little was measured.
  std::vector<Role> month_roles;      ///< (months)
  std::vector<Role> roles;            ///< (parts)

  [[nodiscard]] SiteFacts facts() const;
};

/// The same, as if the months of the final check had not been read yet.
[[nodiscard]] SiteProblem without_shown_months(SiteProblem site);

/// One way in which the site may differ from its model.
struct Candidate {
  const Effect* effect = nullptr;           ///< Null: none.
  int meter = -1;                           ///< Index, for an effect on one meter.
  bool begins = false;                      ///< Has a first day, as an additional parameter.
  bool ends = false;                        ///< Also has a last day.
  std::vector<EffectParameter> parameters;  ///< The effect's own, then its days.

  /// "steam_trap_leak", "scale_fault:steam", "equipment_step@": unique among a site's candidates.
  [[nodiscard]] std::string key(const SiteProblem& site) const;
};

/// An effect that cannot be judged at this site, and the reason.
struct NotIdentifiable {
  std::string effect;
  std::string why;  ///< In words.
};

struct CandidateList {
  std::vector<Candidate> candidates;
  std::vector<NotIdentifiable> not_identifiable;
};

/// Every entry of the catalogue that could be visible with this site's meters, plant and weather.
[[nodiscard]] CandidateList list_candidates(const SiteProblem& site);

/// The candidate's effect at these values, limited to its days.
[[nodiscard]] std::unique_ptr<model::hourly::Alteration> alteration_of(
    const Candidate& candidate, const SiteFacts& facts, std::span<const double> values);

/// Index of the meter that lights and plugs are read off: the first of electricity that counts
/// them. -1: there is none.
[[nodiscard]] Eigen::Index profile_meter(const SiteProblem& site);

/// What the lights and plugs would be if they had been read off the electricity meter with another
/// plant.
///
/// A profile by kind of day and hour is the meter less the plant of the drawings. If more or less
/// plant runs, lights and plugs are as much smaller or larger, so the meter's mean by kind of day
/// and hour is no evidence. Means are plain, where those of a profile are trimmed. The change of
/// the heat in the rooms is left out: it is small.
class ProfileReading {
 public:
  explicit ProfileReading(const SiteProblem& site);

  /// Adds the change to the day parts of the electricity meter, if there is one.
  /// @param use       Of the building as it was run.
  /// @param hours_kW  (hours x m) as modelled with the profile of the drivers.
  /// @param parts_kW  (parts x m) in place.
  void apply(const model::Use& use, const Eigen::ArrayXXd& hours_kW,
             Eigen::ArrayXXd& parts_kW) const;
  /// Takes from what something adds to the meters what the profile has of it already.
  /// @param change_kW  (hours x m) in place.
  void take_usual_day_from(Eigen::ArrayXXd& change_kW) const;

 private:
  static constexpr std::size_t kCells = model::kDayTypes * 24;
  using Cells = std::array<double, kCells>;
  /// Of the meter, over the hours that count.
  [[nodiscard]] Cells means_of(const Eigen::ArrayXXd& hours_kW) const;

  const SiteProblem* site_;
  Eigen::Index meter_ = -1;
  std::vector<std::size_t> cell_;  ///< (hours) kind of day and hour.
  std::vector<char> counts_;       ///< (hours) 1: measured, and may be known to the profile.
  Cells per_hour_{};               ///< 1 / hours that count; 0: none.
  Cells measured_kW_{};            ///< Means.
  Cells lights_kW_{};              ///< Of the drivers. With the plugs they cannot get below zero.
  Cells plugs_kW_{};
};

/// Runs the hourly model for a site and reduces it to day parts. Use one instance per thread:
/// `for_each` hands them out.
class Predictor {
 public:
  /// @param accepted  Effects of the current model version: applied first, in every run.
  /// @param proceed   Called before each run, never from two threads at once. Once it returns
  ///                  false, nothing more is run.
  /// @param executor  Of `for_each`.
  explicit Predictor(const SiteProblem& site,
                     std::vector<std::shared_ptr<const model::hourly::Alteration>> accepted = {},
                     std::function<bool()> proceed = {},
                     ForEachIndex executor = for_each_index_serially);
  Predictor(const Predictor&) = delete;
  Predictor& operator=(const Predictor&) = delete;

  /// Calls `body` for each index below `count` with a predictor of the same model for it alone,
  /// as the executor has it. What it runs counts as run by this one. Bodies must not depend on
  /// each other; those of a body run in its own thread.
  void for_each(std::size_t count, const std::function<void(Predictor&, std::size_t)>& body);
  /// For what needs no predictor.
  [[nodiscard]] const ForEachIndex& executor() const { return executor_; }

  /// Whether it was told to stop; results since then are meaningless, and the caller must give up.
  [[nodiscard]] bool is_stopped() const { return is_stopped_; }

  /// @param theta  (q) in the parameters' units.
  /// @param extra  Applied after the accepted ones; may be null.
  /// @return (parts x m) kW, with lights and plugs as read off the meter with this plant. Valid
  ///         until the next call.
  const Eigen::ArrayXXd& parts_kW(std::span<const double> theta,
                                  const model::hourly::Alteration* extra = nullptr);
  /// From the last call: (hours x m) kW, with lights and plugs as the drivers have them.
  [[nodiscard]] const Eigen::ArrayXXd& hours_kW() const { return hours_kW_; }
  /// What the effect changes while lights and plugs stay. @return (parts x m) kW
  [[nodiscard]] Eigen::ArrayXXd change_kW(std::span<const double> theta,
                                          const model::hourly::Alteration& effect);
  [[nodiscard]] int runs() const { return runs_; }

 private:
  const SiteProblem* site_;
  std::vector<std::shared_ptr<const model::hourly::Alteration>> accepted_;
  std::vector<const model::hourly::Alteration*> active_;
  std::vector<model::MeterMap> maps_;
  model::Building building_;
  model::hourly::Hourly hourly_;
  ProfileReading profile_;
  Eigen::ArrayXXd hours_kW_;
  Eigen::ArrayXXd parts_kW_;
  int runs_ = 0;
  std::function<bool()> proceed_;
  bool is_stopped_ = false;
  ForEachIndex executor_;
  std::mutex mutex_;  ///< Of the two below, and of `proceed_` while there are several.
  std::vector<std::unique_ptr<Predictor>> helpers_;
  std::vector<Predictor*> idle_;
};

/// The error to return when a predictor was stopped.
[[nodiscard]] Error diagnosis_cancelled();

}  // namespace recald::diagnosis
