#include "daemon/site/savings/realised_savings.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "adapters/views/frame/format.hpp"
#include "core/display/id_words.hpp"
#include "daemon/site/model/meter_rates.hpp"
#include "daemon/site/model/site_parts.hpp"

namespace recald::daemon {
namespace {

using assessment::MonthRole;
using metering::Month;
using savings::Estimate;

// Between the 5 % and the 95 % quantile of a normal.
constexpr double kSdsInBand = 3.2897;
// Two normal numbers differ by more in one case of twenty.
constexpr double kSdsApart = 1.96;
constexpr std::size_t kWholeYear = 12;

double sd_of(const Estimate& estimate) { return (estimate.q95 - estimate.q05) / kSdsInBand; }

/// @param days  That the means are of.
AvoidedEnergy avoided_of(const assessment::UnseenMean& mean, double days,
                         const tariff::Rates& rates) {
  const assessment::MonthForecast& expected = mean.forecast;
  const double sd = (expected.q95 - expected.q05) / kSdsInBand;
  AvoidedEnergy avoided{.expected_kWh = expected.mean * days, .avoided_kWh = {}};
  avoided.avoided_kWh = savings::scaled({.mean = expected.mean - mean.measured,
                                         .q05 = expected.q05 - mean.measured,
                                         .q50 = expected.q50 - mean.measured,
                                         .q95 = expected.q95 - mean.measured,
                                         .probability_of_saving = 0.0},
                                        days);
  // A meter that never runs backwards may be forecast as nothing, for certain.
  const double avoided_daily = expected.mean - mean.measured;
  avoided.avoided_kWh.probability_of_saving =
      sd > 0.0 ? savings::normal_estimate(avoided_daily, sd).probability_of_saving
               : (avoided_daily > 0.0 ? 1.0 : 0.0);
  if (rates.per_kWh) avoided.money = savings::scaled(avoided.avoided_kWh, *rates.per_kWh);
  if (rates.emissions_kg_per_kWh) {
    avoided.emissions_kg = savings::scaled(avoided.avoided_kWh, *rates.emissions_kg_per_kWh);
  }
  return avoided;
}

/// The two ways; without a model its forecast is the regression's.
struct Ways {
  const assessment::ForecastAssessment* regression = nullptr;
  const assessment::ForecastAssessment* model = nullptr;
};

Ways ways_of(const SiteCalibration& result, const assessment::OutputAssessment& assessed) {
  const auto* yardstick = assessed.yardstick ? &*assessed.yardstick : nullptr;
  if (!result.with) return {yardstick, nullptr};
  return {yardstick, assessed.by_model ? &*assessed.by_model : &assessed.forecast};
}

MeterSince meter_since(const FinishedCalibration& finished,
                       const assessment::OutputCalibration& output) {
  const SiteCalibration& result = finished.calibration;
  MeterSince meter{.output = output.name,
                   .meter = output.meter_id,
                   .utility = output.utility,
                   .months = 0,
                   .measured_kWh = 0.0,
                   .regression = {},
                   .model = {},
                   .since = {}};
  const Ways ways = ways_of(result, output.assessment);
  const auto at = [](const assessment::ForecastAssessment* way, std::size_t i) {
    return way == nullptr ? std::nullopt : way->months[i];
  };
  double days = 0.0;
  for (std::size_t i = 0; i < result.months.size(); ++i) {
    if (result.roles[i] != MonthRole::validation) continue;
    const double measured = output.measured[i];
    meter.since.push_back({result.months[i], measured, at(ways.regression, i), at(ways.model, i)});
    if (std::isnan(measured)) continue;
    ++meter.months;
    days += result.month_days[i];
    meter.measured_kWh += measured * result.month_days[i];
  }
  const tariff::Rates rates =
      rates_of(finished.modelled.site.config, finished.modelled.recording.meters[output.meter]);
  const auto avoided = [&](const assessment::ForecastAssessment* way) {
    return way == nullptr || !way->unseen_mean
               ? std::nullopt
               : std::optional{avoided_of(*way->unseen_mean, days, rates)};
  };
  meter.regression = avoided(ways.regression);
  meter.model = avoided(ways.model);
  return meter;
}

std::vector<std::string> notes_of(const SavingsSince& savings, const SiteCalibration& result) {
  std::vector<std::string> notes{
      "Avoided energy is what the months after would have used, less what they used. Whatever "
      "else has changed since is in it, not the measure alone."};
  if (savings.left_out) {
    notes.push_back(fmt::format("{} is left out: the change falls within it.",
                                display::month_words(metering::to_string(*savings.left_out))));
  }
  if (savings.before.size() < kWholeYear) {
    notes.push_back(
        fmt::format("There are only {} months before, less than a year: seasons that "
                    "they lack are extrapolated.",
                    savings.before.size()));
  }
  if (savings.after.size() % kWholeYear != 0) {
    notes.push_back(
        fmt::format("The {} months after are no whole years, so the sum must not be "
                    "divided into yearly savings.",
                    savings.after.size()));
  }
  if (!result.with) {
    notes.push_back("There is no option D. " + result.not_calibrated_because);
  }
  return notes;
}

}  // namespace

Result<PeriodConfig> months_about(const OpenSite& site, const Recording& recording,
                                  metering::Instant now, metering::Day since) {
  std::optional<metering::MonthRange> all;
  for (std::size_t i = 0; i < site.config.meters.size(); ++i) {
    const std::string& id = site.config.meters[i].meter.id;
    if (site.config.model && !site.config.model->has_output(id)) continue;
    for (const metering::MonthlyFigure& figure : recording.meters[i].figures) {
      const auto end = site.calendar.month_span(figure.month).end;
      if (!figure.usable || end + site.config.closing.watermark > now) continue;
      if (!all) all = metering::MonthRange{figure.month, figure.month};
      all->first = std::min(all->first, figure.month);
      all->last = std::max(all->last, figure.month);
    }
  }
  const Month month = since.year() / since.month();
  const Month first_after =
      since.day() == std::chrono::day{1} ? month : metering::next_month(month);
  if (!all || !(all->first < month) || all->last < first_after) {
    return failure(
        ErrorCode::not_enough_data,
        all ? fmt::format("'--since {}' leaves no whole month {}: the meters have {} to "
                          "{}",
                          metering::to_string(since), all->first < month ? "after it" : "before it",
                          metering::to_string(all->first), metering::to_string(all->last))
            : "no meter has a usable closed month yet");
  }
  return PeriodConfig{metering::MonthRange{all->first, metering::previous_month(month)},
                      metering::MonthRange{first_after, all->last}};
}

SavingsSince savings_since(const FinishedCalibration& finished, metering::Day since) {
  const SiteCalibration& result = finished.calibration;
  SavingsSince savings{.since = since,
                       .before = {},
                       .after = {},
                       .left_out = {},
                       .meters = {},
                       .notes = {},
                       .warnings = result.warnings};
  if (since.day() != std::chrono::day{1}) savings.left_out = since.year() / since.month();
  for (std::size_t i = 0; i < result.months.size(); ++i) {
    (result.roles[i] == MonthRole::calibration ? savings.before : savings.after)
        .push_back(result.month_names[i]);
  }
  for (const assessment::OutputCalibration& output : result.outputs) {
    if (output.unit != "kW") savings.meters.push_back(meter_since(finished, output));
  }
  savings.notes = notes_of(savings, result);
  return savings;
}

std::string agreement_words(const MeterSince& meter, const display::Unit& energy) {
  if (!meter.regression || !meter.model) return "";
  const Estimate& c = meter.regression->avoided_kWh;
  const Estimate& d = meter.model->avoided_kWh;
  const double apart = d.mean - c.mean;
  const double doubt = kSdsApart * std::hypot(sd_of(c), sd_of(d));
  const std::string words = fmt::format(
      "Option D finds {} {} saved than option C, {} than the {} that both together are "
      "uncertain by",
      views::amount_text(std::abs(apart), energy), apart < 0.0 ? "less" : "more",
      std::abs(apart) <= doubt ? "no more" : "more", views::amount_text(doubt, energy));
  if (std::abs(apart) <= doubt) return words + ": they agree.";
  return words +
         ". The regression knows the temperature alone; the model knows sun, humidity and "
         "timetables, but only as the drawings have them.";
}

}  // namespace recald::daemon
