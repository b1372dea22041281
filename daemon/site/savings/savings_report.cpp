#include "daemon/site/savings/savings_report.hpp"

#include <fmt/format.h>

#include <cmath>
#include <utility>

#include "adapters/views/frame/format.hpp"
#include "adapters/views/frame/provenance.hpp"
#include "core/display/id_words.hpp"
#include "core/display/unit.hpp"
#include "daemon/site/results/report_parts.hpp"

namespace recald::daemon {
namespace {

using savings::Estimate;
using views::count_text;
using views::SavedAmount;
using views::SavingCard;

SavedAmount amount_of(std::string what, std::string unit, const Estimate& estimate,
                      double factor = 1.0) {
  return {.what = std::move(what),
          .unit = std::move(unit),
          .q05 = factor * estimate.q05,
          .q50 = factor * estimate.q50,
          .q95 = factor * estimate.q95,
          .share = {},
          .probability = estimate.probability_of_saving};
}

void add_money(const std::optional<Estimate>& money, const std::optional<Estimate>& emissions_kg,
               const std::string& currency, const std::string& per, SavingCard& card) {
  if (money) card.amounts.push_back(amount_of("Money", currency + per, *money));
  if (emissions_kg) card.amounts.push_back(amount_of("CO2", "t" + per, *emissions_kg, 1e-3));
}

std::string years_text(const std::optional<double>& years) {
  return years ? fmt::format("{:.1f} years", *years) : "never";
}

/// "It saves 12,000 EUR a year (90 %: 8,000 to 15,000) and pays back in 1.2 years (…)."
std::string measure_sentence(const MeasureSaving& saving, const std::string& currency,
                             const std::string& per) {
  std::string sentence;
  if (saving.money) {
    sentence =
        fmt::format("Saves {} {}{} (90 %: {} to {}).", count_text(saving.money->q50), currency, per,
                    count_text(saving.money->q05), count_text(saving.money->q95));
  }
  if (saving.payback) {
    sentence +=
        fmt::format(" It costs {} {} and pays back in {} (90 %: {} to {}).",
                    count_text(*saving.cost), currency, years_text(saving.payback->q50_years),
                    years_text(saving.payback->q05_years), years_text(saving.payback->q95_years));
  }
  return sentence;
}

SavingCard card_of(const FinishedCalibration& finished, const MeasureSaving& saving,
                   const std::string& per) {
  const std::string& currency = finished.modelled.site.config.tariff.currency;
  SavingCard card{.title = saving.name,
                  .sentence = measure_sentence(saving, currency, per),
                  .caption = fmt::format("{}: what it saves; more use is negative", saving.name),
                  .amounts = {},
                  .notes = saving.notes};
  for (const MeterSaving& meter : saving.meters) {
    const display::Unit unit =
        display::unit_of(finished.calibration.units, meter.is_peak ? "kW" : "kWh", meter.utility);
    SavedAmount amount =
        amount_of(display::meter_label(meter.meter) + (meter.is_peak ? ", mean monthly peak" : ""),
                  meter.is_peak ? unit.name : unit.name + per, meter.saved, unit.factor);
    if (meter.baseline > 0.0) amount.share = meter.saved.q50 / meter.baseline;
    card.amounts.push_back(std::move(amount));
  }
  add_money(saving.money, saving.emissions_kg, currency, per, card);
  return card;
}

/// The first sentence: of the measure, or of all of them together, which stand last.
std::string headline_of(const FinishedCalibration& finished, const SiteSavings& savings,
                        const std::string& per) {
  const MeasureSaving& last = savings.measures.back();
  const std::string sentence =
      measure_sentence(last, finished.modelled.site.config.tariff.currency, per);
  if (!sentence.empty()) return fmt::format("{}: {}", last.name, display::uncapitalised(sentence));
  double saved = 0.0;
  for (const MeterSaving& meter : last.meters) saved += meter.is_peak ? 0.0 : meter.saved.q50;
  return fmt::format("{}: saves some {} kWh{} of all meters.", last.name, count_text(saved), per);
}

views::SavingsData frame_of(const FinishedCalibration& finished, std::string title,
                            std::string generated_at) {
  const SiteConfig& config = finished.modelled.site.config;
  return {.title = std::move(title),
          .site = site_line_of(config),
          .generated_at = std::move(generated_at),
          .headline = {},
          .cards = {},
          .months = {},
          .months_before = {},
          .months_after = {},
          .not_known = {},
          .notices = {},
          .provenance = views::sampled_provenance_of(finished.modelled.facts)};
}

void add_way(const AvoidedEnergy& way, const std::string& name, const display::Unit& unit,
             const std::string& currency, SavingCard& card) {
  SavedAmount amount = amount_of(name, unit.name, way.avoided_kWh, unit.factor);
  if (way.expected_kWh > 0.0) amount.share = way.avoided_kWh.q50 / way.expected_kWh;
  card.amounts.push_back(std::move(amount));
  if (way.money) card.amounts.push_back(amount_of(name + ": money", currency, *way.money));
  if (way.emissions_kg) {
    card.amounts.push_back(amount_of(name + ": CO2", "t", *way.emissions_kg, 1e-3));
  }
}

constexpr const char* kOptionC = "Option C, regression on temperature";
constexpr const char* kOptionD = "Option D, calibrated model";

SavingCard card_of(const FinishedCalibration& finished, const MeterSince& meter) {
  const std::string label = display::meter_label(meter.meter);
  const display::Unit unit = display::unit_of(finished.calibration.units, "kWh", meter.utility);
  const std::string& currency = finished.modelled.site.config.tariff.currency;
  SavingCard card{
      .title = label,
      .sentence = fmt::format("Measured since: {} in {} months.",
                              views::amount_text(meter.measured_kWh, unit), meter.months),
      .caption = fmt::format("{}: energy avoided since; more use is negative", label),
      .amounts = {},
      .notes = {}};
  if (meter.regression) add_way(*meter.regression, kOptionC, unit, currency, card);
  if (meter.model) add_way(*meter.model, kOptionD, unit, currency, card);
  if (std::string words = agreement_words(meter, unit); !words.empty()) {
    card.notes.push_back(std::move(words));
  }
  if (card.amounts.empty()) {
    card.notes.emplace_back("Too little of it was measured to say what it would have used.");
  }
  return card;
}

/// The model's band where there is a model, else the regression's.
views::ForecastSeries series_of(const FinishedCalibration& finished, const MeterSince& meter) {
  const display::Unit unit = display::unit_of(finished.calibration.units, "kWh/day", meter.utility);
  views::ForecastSeries series{
      .label = display::capitalised(display::output_words(meter.output)),
      .unit = unit.name,
      .trust = fmt::format("Band: what the months would have shown without the measure, by {}; "
                           "nine of ten should lie inside if it did nothing.",
                           meter.model ? "the calibrated model" : "the regression"),
      .months = {},
      .alarms = {}};
  for (const MonthSince& month : meter.since) {
    const auto& expected = meter.model ? month.model : month.regression;
    views::ForecastMonth shown{
        .month = month.month, .q05 = {}, .q50 = {}, .q95 = {}, .measured = {}};
    if (expected) {
      shown.q05 = unit.shown(expected->q05);
      shown.q50 = unit.shown(expected->q50);
      shown.q95 = unit.shown(expected->q95);
    }
    if (!std::isnan(month.measured)) shown.measured = unit.shown(month.measured);
    series.months.push_back(shown);
  }
  return series;
}

/// All meters together, by the model where there is one.
std::string headline_of(const FinishedCalibration& finished, const SavingsSince& savings) {
  std::vector<std::string> parts;
  for (const MeterSince& meter : savings.meters) {
    const auto& way = meter.model ? meter.model : meter.regression;
    if (!way) continue;
    const display::Unit unit = display::unit_of(finished.calibration.units, "kWh", meter.utility);
    parts.push_back(fmt::format("{} {} {} (90 %: {} to {})", display::id_words(meter.meter),
                                views::amount_text(std::abs(way->avoided_kWh.q50), unit),
                                way->avoided_kWh.q50 < 0.0 ? "more" : "less",
                                views::number_text(unit.shown_difference(way->avoided_kWh.q05)),
                                views::number_text(unit.shown_difference(way->avoided_kWh.q95))));
  }
  std::string words =
      fmt::format("Since {} the building used ", metering::to_string(savings.since));
  if (parts.empty()) return "Nothing can be said of what was saved: too little was measured.";
  for (std::size_t i = 0; i < parts.size(); ++i) {
    words += (i == 0 ? "" : i + 1 == parts.size() ? " and " : ", ") + parts[i];
  }
  return words + " than it would have.";
}

}  // namespace

views::SavingsData savings_report_of(const FinishedCalibration& finished,
                                     const SiteSavings& savings, std::string generated_at) {
  const std::string& name = finished.modelled.site.config.name;
  views::SavingsData data =
      frame_of(finished, "What measures would save at " + name, std::move(generated_at));
  const std::string per =
      savings.is_year ? " a year" : fmt::format(" in {} months", savings.months.size());
  data.headline = headline_of(finished, savings, per);
  for (const MeasureSaving& saving : savings.measures) {
    data.cards.push_back(card_of(finished, saving, per));
  }
  data.not_known = savings.notes;
  return data;
}

views::SavingsData savings_report_of(const FinishedCalibration& finished,
                                     const SavingsSince& savings, std::string generated_at) {
  const std::string& name = finished.modelled.site.config.name;
  views::SavingsData data =
      frame_of(finished, "What has been saved at " + name, std::move(generated_at));
  data.headline = headline_of(finished, savings);
  for (const MeterSince& meter : savings.meters) {
    data.cards.push_back(card_of(finished, meter));
    if (!meter.since.empty()) data.months.push_back(series_of(finished, meter));
  }
  data.months_before = savings.before;
  data.months_after = savings.after;
  data.not_known = savings.notes;
  for (const display::Warning& warning : savings.warnings) {
    data.notices.push_back(views::notice_of(views::Severity::info, warning));
  }
  return data;
}

}  // namespace recald::daemon
