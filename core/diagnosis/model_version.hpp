/// A version of a site's model: the drawings, and the effects that were added one by one.
///
/// Versions never change; changes make new ones. So the basis on which an effect was accepted stays
/// readable, and every addition can be reverted.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/metering/civil_time.hpp"
#include "core/model/prior.hpp"

namespace recald::diagnosis {

/// The version without effects: the model as the site file describes it.
inline constexpr std::string_view kBaseVersion = "drawings";

/// One parameter of an effect before and after the diagnosis, in the parameter's unit.
struct EffectParameterRecord {
  std::string name;
  std::string unit;
  Prior prior;
  double mean;  ///< Of the posterior, as all below.
  double sd;
  double q05;
  double q50;
  double q95;
  /// Posterior draws; entry i of all parameters of an effect is one joint draw.
  std::vector<double> draws = {};
  bool operator==(const EffectParameterRecord&) const = default;
};

/// What the effect changes at a meter per month, mean over `months_used` and the posterior.
struct MeterImpact {
  std::string meter;
  double monthly_kWh;  ///< With the effect minus without it.
  bool operator==(const MeterImpact&) const = default;
};

/// Another explanation that was considered: an effect's id, "none" or "unknown".
struct Rival {
  std::string effect;
  double probability;
  bool operator==(const Rival&) const = default;
};

/// An effect in a model, with the evidence on which it was accepted.
struct AddedEffect {
  std::string effect;                 ///< Id in the catalogue.
  std::string title;                  ///< "Night set-back missing"
  std::string meter;                  ///< For an effect on one meter's record; else empty.
  std::optional<metering::Day> from;  ///< First day of the effect; absent: from the beginning.
  std::optional<metering::Day> to;    ///< First day without the effect again; absent: to the end.
  std::string physics;                ///< The equation as text, with units.
  std::vector<EffectParameterRecord> parameters;
  double log_evidence_gain;  ///< ln of the evidence with it over that without, nats.
  double probability;        ///< 0…1
  std::vector<Rival> rivals = {};
  std::vector<MeterImpact> impacts = {};
  /// Months used by the diagnosis, ascending. They must not be used for these parameters again.
  std::vector<metering::Month> months_used = {};
  bool operator==(const AddedEffect&) const = default;
};

enum class VersionAuthor { automatic, human };
inline constexpr std::array<std::string_view, 2> kVersionAuthors = {"auto", "human"};

enum class VersionStatus {
  proposed,  ///< Written, but never in force.
  accepted,
  retired,   ///< Later data spoke against its effect.
  reverted,  ///< Withdrawn.
};
inline constexpr std::array<std::string_view, 4> kVersionStatuses = {"proposed", "accepted",
                                                                     "retired", "reverted"};

[[nodiscard]] constexpr std::string_view name_of(VersionAuthor author) {
  return kVersionAuthors[static_cast<std::size_t>(author)];
}
[[nodiscard]] constexpr std::string_view name_of(VersionStatus status) {
  return kVersionStatuses[static_cast<std::size_t>(status)];
}

struct ModelVersion {
  std::string version;  ///< SHA-256 of everything except status and time, hex; or `kBaseVersion`.
  std::string parent;   ///< Empty for the base version.
  std::string site_id;
  std::string created_at;  ///< ISO 8601, UTC.
  VersionAuthor author = VersionAuthor::human;
  VersionStatus status = VersionStatus::proposed;
  std::string data_revision;      ///< SHA-256 over the site file and its data.
  std::string catalogue_version;  ///< The program version whose catalogue the effects are from.
  std::vector<AddedEffect> effects = {};  ///< All effects of the model, in the order of addition.
  bool operator==(const ModelVersion&) const = default;
};

[[nodiscard]] inline ModelVersion base_version(std::string site_id) {
  ModelVersion base;
  base.version = kBaseVersion;
  base.site_id = std::move(site_id);
  base.status = VersionStatus::accepted;
  return base;
}

/// Whether the effect may learn from the month: the month comes after all that it was learnt from.
[[nodiscard]] bool may_learn_from(const AddedEffect& effect, metering::Month month);

/// The name of an effect's parameter among those of a design or a calibration:
/// "night_setback_missing_share"; with its meter if it has one, "meter_scale_heat_factor".
[[nodiscard]] std::string effect_parameter_name(const AddedEffect& effect,
                                                const EffectParameterRecord& parameter);

/// The first twelve digits of a version, for people to read and type.
[[nodiscard]] inline std::string short_version(std::string_view version) {
  return std::string{version.substr(0, 12)};
}

}  // namespace recald::diagnosis
