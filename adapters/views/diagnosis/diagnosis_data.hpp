/// Everything that a diagnosis page shows, as plain values and finished sentences.
///
/// Absent values (an empty vector, a NaN) are left out or shown as a dash, so the page also works
/// for a diagnosis that added nothing, kept no month back or lost a meter.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "adapters/views/frame/report_data.hpp"
#include "core/diagnosis/check/gap.hpp"
#include "core/diagnosis/evidence/locate.hpp"
#include "core/diagnosis/evidence/residual_map.hpp"
#include "core/diagnosis/model_version.hpp"
#include "core/diagnosis/naming.hpp"
#include "core/diagnosis/naming/monthly_vote.hpp"

namespace recald::views {

/// A parameter of an effect with its posterior; a date is text, everything else a number.
struct EffectParameterRow {
  std::string name;
  std::string mode;  ///< As shown to readers, with its unit.
  std::string low;   ///< 5 %
  std::string high;  ///< 95 %
};

/// What an effect does to a meter.
struct Impact {
  std::string meter;
  std::string a_month;  ///< On average: "+4,200 kWh".
};

/// An effect that was added, or tried and withdrawn.
struct AddedEffectCard {
  std::string title;
  std::string meaning;
  std::string physics;
  std::string when;  ///< "At all times of the record", "Since about 12 Mar 2021 (…)".
  double probability;
  std::vector<Impact> impacts;
  std::vector<EffectParameterRow> parameters;
};

enum class CandidateKind { effect, none, unknown };

struct CandidateBar {
  std::string label;
  std::string meaning;
  CandidateKind kind;
  double probability;
  double if_half_lack_nothing;         ///< Probability where half of all models lack nothing …
  double if_nine_in_ten_lack_nothing;  ///< … and where nine in ten do.
  double evidence_gain;  ///< Log evidence compared with no effect, nats; NaN if not applicable.
  std::vector<EffectParameterRow> parameters;
};

/// A figure of a meter by which an effect shows.
struct SignRow {
  std::string effect;
  std::string meter;  ///< "Electricity"
  std::string where;  ///< "Sundays, when mild, 16 to 18 h"
  double without;     ///< Measured minus modelled, as a share …
  double with;        ///< … and with the effect in the model.
};

/// Two effects that look alike on these meters, and the measurement that would tell them apart.
struct Separation {
  std::string effect;
  std::string rival;
  double rival_probability;  ///< NaN if the rival was not among the fitted effects.
  std::string measurement;
};

/// One meter's residuals before and after the additions.
struct MeterMaps {
  std::string meter;
  std::string mean_load;  ///< Measured, "41.2 kW"; what the shares are shares of.
  diagnosis::ResidualMap before;
  std::optional<diagnosis::ResidualMap> after;
};

/// One version of the model on the months kept back, for every meter.
struct GapStep {
  std::string label;                      ///< "The model as drawn", "with night set-back missing".
  std::vector<diagnosis::MeterGap> gaps;  ///< (m) NaN for a meter without data to judge by.
};

/// What one addition explains at one meter.
struct EffectSignature {
  std::string effect;
  std::string meter;
  diagnosis::Signature residual;  ///< Measured minus modelled, before the addition.
  diagnosis::Signature change;    ///< What the model changed, with its other parameters refitted.
  diagnosis::Signature effect_alone;
};

struct NotIdentifiableRow {
  std::string effect;
  std::string why;
};

struct DiagnosisData {
  std::string title;
  std::string generated_at;  ///< Set by the caller; the page has no clock.
  SiteLine site;
  Provenance provenance;

  diagnosis::Outcome outcome = diagnosis::Outcome::none;
  bool not_confirmed = false;  ///< Named, then withdrawn: the months kept back did not agree.
  std::string headline;
  std::vector<std::string> explanations;
  std::vector<Notice> notices;
  std::vector<AddedEffectCard> added;

  std::vector<std::string> meters;         ///< (m)
  std::vector<display::MeterUnits> units;  ///< (m)
  std::vector<metering::Month> months;     ///< Of the maps' columns.
  std::vector<diagnosis::Role> uses;       ///< (months)
  std::vector<double> temperature_limits;  ///< In the unit of temperature.
  std::string temperature_unit = "°C";
  std::vector<MeterMaps> maps;  ///< (m)

  std::vector<diagnosis::Misfit> located;
  std::vector<diagnosis::Misfit> located_after;  ///< With the additions.
  std::vector<CandidateBar> candidates;          ///< Descending in probability.
  std::vector<SignRow> signs;                    ///< Of likely effects, the likeliest first.
  std::vector<Separation> separations;
  std::vector<GapStep> steps;  ///< Empty: no month was kept back.
  /// Of models other than the hourly one, given the same effects; outputs under
  /// their readable names.
  std::vector<diagnosis::ModelGap> other_gaps;
  std::vector<EffectSignature> signatures;
  std::vector<diagnosis::MeterGap> base_fit;  ///< (m) on the fitted months.
  std::vector<NotIdentifiableRow> not_identifiable;
};

}  // namespace recald::views
