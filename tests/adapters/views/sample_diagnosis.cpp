#include "tests/adapters/views/sample_diagnosis.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "adapters/views/frame/format.hpp"
#include "core/random/rng.hpp"

namespace recald::views {
namespace {

using diagnosis::MeterGap;
using diagnosis::Outcome;
using diagnosis::Role;
using std::chrono::month;
using std::chrono::year;

constexpr double kNothing = std::numeric_limits<double>::quiet_NaN();
constexpr int kMonths = 24;
constexpr Eigen::Index kPartsOfWeek = 42;
const std::vector<double> kLimits_C{-10, -5, 0, 5, 10, 15, 20, 25, 30, 35};

bool is_night(Eigen::Index part_of_week) { return part_of_week % 6 == 0 || part_of_week % 6 == 5; }

/// Noise, and at night a surplus that grows with the cold.
diagnosis::ResidualMap invented_map(double surplus, Rng& rng) {
  diagnosis::ResidualMap map;
  map.by_month.resize(kPartsOfWeek, kMonths);
  for (Eigen::Index m = 0; m < kMonths; ++m) {
    const double cold =
        0.5 + 0.5 * std::cos(2.0 * std::numbers::pi * static_cast<double>(m) / 12.0);
    for (Eigen::Index part = 0; part < kPartsOfWeek; ++part) {
      map.by_month(part, m) = (is_night(part) ? surplus * cold : 0.0) + 0.02 * rng.normal();
    }
  }
  const auto bins = static_cast<Eigen::Index>(kLimits_C.size()) - 1;
  map.by_temperature.resize(6, bins);
  for (Eigen::Index bin = 0; bin < bins; ++bin) {
    const double cold = std::max(0.0, 1.0 - static_cast<double>(bin) / 5.0);
    for (Eigen::Index part = 0; part < 6; ++part) {
      map.by_temperature(part, bin) = (is_night(part) ? surplus * cold : 0.0) + 0.01 * rng.normal();
    }
  }
  return map;
}

diagnosis::Signature invented_signature(double size) {
  diagnosis::Signature signature{Eigen::ArrayXd(kPartsOfWeek), Eigen::ArrayXd(9)};
  for (Eigen::Index part = 0; part < kPartsOfWeek; ++part) {
    signature.by_part_of_week[part] = is_night(part) ? size : -0.2 * size;
  }
  for (Eigen::Index bin = 0; bin < 9; ++bin) {
    signature.by_temperature[bin] = size * (1.0 - static_cast<double>(bin) / 5.0);
  }
  return signature;
}

MeterGap gap(double cvrmse_daily, double log_score) {
  return {.nmbe_sim_minus_meas = -0.2 * cvrmse_daily,
          .cvrmse_daily = cvrmse_daily,
          .cvrmse_monthly = 0.4 * cvrmse_daily,
          .log_score = log_score,
          .discrepancy_share = 0.61};
}

diagnosis::Misfit finding(std::size_t meter, std::string words, double share, double share_se,
                          double kWh_month) {
  return {.meter = meter,
          .words = std::move(words),
          .share = share,
          .share_se = share_se,
          .kWh_month = kWh_month};
}

void add_words(DiagnosisData& data) {
  data.headline = "Missing in the model: \"Night set-back missing\".";
  data.explanations = {
      "One effect explains the gap better than all others together.",
      "Scatter of days (CV(RMSE)) on the 5 months kept back: Steam 14.2 % before, 8.1 % after."};
  data.notices = {{Severity::info, "These numbers are invented: a sample of a diagnosis page."}};
  data.added = {{.title = "Night set-back missing",
                 .meaning = "Rooms are kept as warm at night and on weekends as by day.",
                 .physics = "unoccupied set-points = occupied ones, share s of the difference",
                 .when = "Since about 12 Mar 2021 (90 %: 1 Mar 2021 to 20 Mar 2021).",
                 .probability = 0.93,
                 .impacts = {{"Chilled water", "−310 kWh"},
                             {"Steam", "+4,230 kWh"},
                             {"Electricity", "+85 kWh"}},
                 .parameters = {{"missing share", "0.82", "0.61", "0.97"},
                                {"first day", "12 Mar 2021", "1 Mar 2021", "20 Mar 2021"}}}};
  data.located = {finding(1, "working days 00-04 h", 0.142, 0.03, 2'100.0),
                  finding(1, "outdoor temperature below -2.5 degC", 0.118, 0.03, 1'700.0),
                  finding(0, "Jul 2021", -0.061, 0.02, -420.0)};
  data.located_after = {finding(0, "Jul 2021", -0.055, 0.02, -390.0)};
  data.candidates = {{"Night set-back missing", "Rooms are kept warm at night.",
                      CandidateKind::effect, 0.93, 0.93, 0.9, 41.2, data.added[0].parameters},
                     {"Something else",
                      "A pattern that no effect makes.",
                      CandidateKind::unknown,
                      0.04,
                      0.04,
                      0.035,
                      18.0,
                      {}},
                     {"Steam or heat leaks in the pipes",
                      "Heat is drawn day and night.",
                      CandidateKind::effect,
                      0.025,
                      0.025,
                      0.024,
                      22.5,
                      {{"heat loss", "41 kW", "30 kW", "52 kW"}}},
                     {"No effect",
                      "The model lacks nothing.",
                      CandidateKind::none,
                      0.005,
                      0.005,
                      0.041,
                      kNothing,
                      {}}};
  data.separations = {{"Night set-back missing", "Steam or heat leaks in the pipes", 0.025,
                       "Room temperature of two winter nights: a leak warms no room."},
                      {"Night set-back missing", "Thermal mass", kNothing,
                       "How fast rooms cool in the first hours of a cold night."}};
  data.not_identifiable = {{"Wind drives leakage", "the weather record has no wind"},
                           {"Heat pump loses to frost", "there is no heat pump"}};
}

}  // namespace

DiagnosisData sample_diagnosis() {
  Rng rng{20'261'121};
  DiagnosisData data;
  data.title = "Diagnosis (sample, invented numbers)";
  data.generated_at = "2023-01-05 09:30 (UTC−05:00)";
  data.site = {"sample-laboratory", "Sample Laboratory Building", "America/New_York"};
  data.provenance = {.recald_version = "0.1.0",
                     .data_revision = "9f2c51d07e6b4a83",
                     .model_version = "hourly-3b1c",
                     .time_zone_data = "2025b",
                     .catalogue = "40 effects, of recald 0.1.0",
                     .seed = 1};
  data.outcome = Outcome::named;
  add_words(data);
  data.meters = {"Chilled water", "Steam", "Electricity"};
  for (int i = 0; i < kMonths; ++i) {
    data.months.push_back(year{2021 + i / 12} / month{static_cast<unsigned>(i % 12) + 1});
    data.uses.push_back(i >= 21 || i == 6 || i == 13 ? Role::show
                        : i % 5 == 2                 ? Role::select
                                                     : Role::fit);
  }
  data.units.resize(data.meters.size());
  data.temperature_limits = kLimits_C;
  const std::vector<double> surplus{-0.05, 0.28, 0.02};
  for (std::size_t g = 0; g < data.meters.size(); ++g) {
    data.maps.push_back({data.meters[g], amount_text(120.0 + 40.0 * static_cast<double>(g), {"kW"}),
                         invented_map(surplus[g], rng), invented_map(0.1 * surplus[g], rng)});
    data.signatures.push_back({"Night set-back missing", data.meters[g],
                               invented_signature(surplus[g]), invented_signature(0.9 * surplus[g]),
                               invented_signature(1.4 * surplus[g])});
  }
  data.maps[1].before.by_month.col(9).setConstant(kNothing);
  data.maps[1].after->by_month.col(9).setConstant(kNothing);
  data.steps = {
      {"as drawn", {gap(0.093, -310.0), gap(0.142, -402.5), gap(0.051, -250.0)}},
      {"+ Night set-back missing", {gap(0.09, -306.0), gap(0.081, -351.0), gap(0.051, -250.5)}}};
  data.base_fit = data.steps[0].gaps;
  return data;
}

DiagnosisData unconfirmed_diagnosis() {
  DiagnosisData data = sample_diagnosis();
  data.not_confirmed = true;
  data.headline = "Not confirmed: \"Night set-back missing\" was tried and withdrawn.";
  const std::string hostile = "</script><script>alert(\"&'\")</script><!--";
  data.title = data.site.name = hostile;
  data.added[0].title = data.added[0].meaning = data.added[0].physics = hostile;
  data.added[0].when = data.added[0].impacts[0].meter = hostile;
  data.added[0].parameters[0] = {hostile, hostile, hostile, hostile};
  data.explanations[0] = data.located[0].words = hostile;
  data.candidates[1].label = data.candidates[1].meaning = hostile;
  data.separations[0] = {hostile, hostile, kNothing, hostile};
  data.meters[2] = data.maps[2].meter = data.signatures[0].effect = hostile;
  data.signatures[0].meter = data.steps[1].label = hostile;
  data.not_identifiable[0] = {hostile, hostile};
  for (GapStep& step : data.steps) {
    step.gaps[2] = {kNothing, kNothing, kNothing, kNothing, kNothing};
  }
  return data;
}

DiagnosisData empty_handed_diagnosis() {
  DiagnosisData data = sample_diagnosis();
  data.outcome = Outcome::none;
  data.headline = "The calibrated model follows the meters within what chance explains.";
  data.explanations = {"No effect is supported strongly enough."};
  data.added.clear();
  data.located.clear();
  data.located_after.clear();
  data.separations.clear();
  data.steps.clear();
  data.signatures.clear();
  data.months.resize(4);
  data.uses.assign(4, Role::fit);
  for (MeterMaps& maps : data.maps) {
    maps.after.reset();
    maps.before.by_month = maps.before.by_month.leftCols(4).eval();
  }
  data.maps[1].before.by_month.setConstant(kNothing);
  data.maps[1].before.by_temperature.setConstant(kNothing);
  data.maps[1].mean_load = "–";
  return data;
}

}  // namespace recald::views
