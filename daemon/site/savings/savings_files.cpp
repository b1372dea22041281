#include "daemon/site/savings/savings_files.hpp"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <utility>

#include "adapters/results/job_result_json.hpp"
#include "adapters/shapes/assessment_shapes.hpp"
#include "adapters/shapes/shape_json.hpp"
#include "adapters/system/files/write_file.hpp"
#include "adapters/views/frame/provenance.hpp"
#include "adapters/views/savings/savings_page.hpp"
#include "core/display/warning.hpp"
#include "daemon/site/savings/savings_report.hpp"

SHAPE(recald::savings::Estimate, mean, q05, q50, q95, probability_of_saving);
SHAPE(recald::daemon::AvoidedEnergy, expected_kWh, avoided_kWh, money, emissions_kg);

namespace recald::daemon {
namespace {

// Keys in the order they are written: files are read by people too.
using Json = nlohmann::ordered_json;

Json meter_json(const MeterSaving& meter) {
  return {{"output", meter.output},
          {"meter", meter.meter},
          {"unit", meter.is_peak ? "kW" : "kWh"},
          {"baseline", results::number(meter.baseline)},
          {"saved", shapes::json_of(meter.saved)},
          {"share", results::number(meter.saved.q50 / meter.baseline)},
          {"money", shapes::json_of(meter.money)},
          {"emissions_kg", shapes::json_of(meter.emissions_kg)}};
}

Json measure_json(const MeasureSaving& saving) {
  Json meters = Json::array();
  for (const MeterSaving& meter : saving.meters) meters.push_back(meter_json(meter));
  Json json = {{"name", saving.name},
               {"cost", shapes::json_of(saving.cost)},
               {"meters", meters},
               {"money", shapes::json_of(saving.money)},
               {"emissions_kg", shapes::json_of(saving.emissions_kg)},
               {"payback_years", nullptr},
               {"notes", saving.notes}};
  if (const auto& payback = saving.payback) {
    json["payback_years"] = {{"q05", shapes::json_of(payback->q05_years)},
                             {"q50", shapes::json_of(payback->q50_years)},
                             {"q95", shapes::json_of(payback->q95_years)}};
  }
  return json;
}

Json since_json(const MeterSince& meter) {
  Json months = Json::array();
  for (const MonthSince& month : meter.since) {
    months.push_back({{"month", metering::to_string(month.month)},
                      {"measured", results::number(month.measured)},
                      {"option_c", shapes::json_of(month.regression)},
                      {"option_d", shapes::json_of(month.model)}});
  }
  return {{"output", meter.output},
          {"meter", meter.meter},
          {"months", meter.months},
          {"measured_kWh", results::number(meter.measured_kWh)},
          {"option_c", shapes::json_of(meter.regression)},
          {"option_d", shapes::json_of(meter.model)},
          {"agreement", agreement_words(meter, {"kWh"})},
          {"by_month_kWh_day", months}};
}

std::string finished_json(Json json, const FinishedCalibration& finished) {
  const RunFacts& facts = finished.modelled.facts;
  json["warnings"] = display::texts_of(finished.calibration.warnings);
  json["seed"] = facts.seed;
  views::add_provenance(facts, json);
  return json.dump(2) + "\n";
}

/// A name with commas or quotes, as CSV has it.
std::string quoted(const std::string& text) {
  std::string out = "\"";
  for (const char c : text) out += c == '"' ? std::string{"\"\""} : std::string{c};
  return out + "\"";
}

std::string savings_csv(const SiteSavings& savings) {
  std::string csv = "measure,output,unit,baseline,saved_q05,saved_q50,saved_q95,probability\n";
  for (const MeasureSaving& saving : savings.measures) {
    for (const MeterSaving& meter : saving.meters) {
      csv +=
          fmt::format("{},{},{},{:.6g},{:.6g},{:.6g},{:.6g},{:.4f}\n", quoted(saving.name),
                      meter.output, meter.is_peak ? "kW" : "kWh", meter.baseline, meter.saved.q05,
                      meter.saved.q50, meter.saved.q95, meter.saved.probability_of_saving);
    }
  }
  return csv;
}

/// Empty where nothing is known.
std::string band_csv(const std::optional<assessment::MonthForecast>& forecast) {
  if (!forecast) return ",,";
  return fmt::format("{:.6g},{:.6g},{:.6g}", forecast->q05, forecast->q50, forecast->q95);
}

std::string savings_csv(const SavingsSince& savings) {
  std::string csv =
      "output,month,measured_kWh_day,option_c_q05,option_c_q50,option_c_q95,option_d_q05,"
      "option_d_q50,option_d_q95\n";
  for (const MeterSince& meter : savings.meters) {
    for (const MonthSince& month : meter.since) {
      csv += fmt::format("{},{},{},{},{}\n", meter.output, metering::to_string(month.month),
                         std::isnan(month.measured) ? "" : fmt::format("{:.6g}", month.measured),
                         band_csv(month.regression), band_csv(month.model));
    }
  }
  return csv;
}

Result<void> write_three(const std::filesystem::path& folder, const std::string& json,
                         const std::string& csv, const std::string& page) {
  if (auto made = system::make_folder(folder); !made) return made;
  if (auto written = system::write_file(folder / "ecm.json", json); !written) return written;
  if (auto written = system::write_file(folder / "savings.csv", csv); !written) return written;
  return system::write_file(folder / "savings.html", page);
}

}  // namespace

std::string savings_json(const FinishedCalibration& finished, const SiteSavings& savings) {
  Json measures = Json::array();
  for (const MeasureSaving& saving : savings.measures) measures.push_back(measure_json(saving));
  return finished_json({{"model", name_of(finished.calibration.model)},
                        {"months", savings.months},
                        {"is_year", savings.is_year},
                        {"draws", savings.draws},
                        {"currency", finished.modelled.site.config.tariff.currency},
                        {"measures", measures},
                        {"notes", savings.notes}},
                       finished);
}

std::string savings_json(const FinishedCalibration& finished, const SavingsSince& savings) {
  Json meters = Json::array();
  for (const MeterSince& meter : savings.meters) meters.push_back(since_json(meter));
  return finished_json(
      {{"model", finished.calibration.with ? Json(name_of(finished.calibration.model)) : Json()},
       {"since", metering::to_string(savings.since)},
       {"months_before", savings.before},
       {"months_after", savings.after},
       {"month_left_out",
        savings.left_out ? Json(metering::to_string(*savings.left_out)) : Json(nullptr)},
       {"currency", finished.modelled.site.config.tariff.currency},
       {"meters", meters},
       {"notes", savings.notes}},
      finished);
}

Result<void> write_savings(const FinishedCalibration& finished, const SiteSavings& savings,
                           std::string generated_at, const std::string& json,
                           const std::filesystem::path& folder) {
  return write_three(
      folder, json, savings_csv(savings),
      views::render_savings(savings_report_of(finished, savings, std::move(generated_at))));
}

Result<void> write_savings(const FinishedCalibration& finished, const SavingsSince& savings,
                           std::string generated_at, const std::string& json,
                           const std::filesystem::path& folder) {
  return write_three(
      folder, json, savings_csv(savings),
      views::render_savings(savings_report_of(finished, savings, std::move(generated_at))));
}

}  // namespace recald::daemon
