#include "daemon/fleet/work/job_summary.hpp"

#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "adapters/results/job_result_json.hpp"

namespace recald::daemon {
namespace {

using Json = nlohmann::ordered_json;

constexpr double kDaysPerMonth = 365.25 / 12.0;

/// Null where anything on the way is missing.
Json at(const Json& json, std::initializer_list<const char*> path) {
  const Json* here = &json;
  for (const char* key : path) {
    const auto next = here->is_object() ? here->find(key) : here->end();
    if (next == here->end()) return nullptr;
    here = &*next;
  }
  return *here;
}

std::optional<double> price_of(const SiteConfig& site, const std::string& meter) {
  const auto index = site.meter_index(meter);
  if (!index) return {};
  const auto& prices = site.tariff.prices_of(site.meters[*index].meter.utility);
  return prices ? std::optional{prices->per_kWh} : std::nullopt;
}

Json money(const std::optional<double>& price, double kWh_month) {
  return price ? results::number(*price * kWh_month) : Json(nullptr);
}

double mean_of(const Json& months) {
  double sum = 0.0;
  int count = 0;
  for (const Json& month : months) {
    const Json measured = at(month, {"measured_kWh"});
    if (!measured.is_number() || at(month, {"role"}) != "calibration") continue;
    sum += measured.get<double>();
    ++count;
  }
  return count > 0 ? sum / count : kAbsent;
}

Json outputs_of(const SiteConfig& site, const Json& document) {
  Json list = Json::array();
  for (const Json& output : at(document, {"outputs"})) {
    const std::string name = output.value("name", "");
    const std::string meter = output.value("meter", "");
    const Json fit = at(document, {"after", "calibration", name.c_str()});
    const Json nmbe = at(fit, {"nmbe_sim_minus_meas"});
    const double measured = mean_of(at(output, {"months"}));
    const bool is_energy = output.value("unit", "") == "kWh/day";
    const double gap_kWh_month =
        nmbe.is_number() && is_energy ? -nmbe.get<double>() * measured * kDaysPerMonth : kAbsent;
    list.push_back({{"name", name},
                    {"meter", meter},
                    {"unit", output.value("unit", "")},
                    {"measured", results::number(measured)},
                    {"nmbe", nmbe},
                    {"cvrmse", at(fit, {"cvrmse"})},
                    {"gap_kWh_month", results::number(gap_kWh_month)},
                    {"gap_money_month", money(price_of(site, meter), gap_kWh_month)}});
  }
  return list;
}

Json named_of(const SiteConfig& site, const Json& document) {
  Json list = Json::array();
  for (const Json& addition : at(document, {"additions"})) {
    double cost = 0.0;
    bool is_known = false;
    const Json monthly = at(addition, {"monthly_kWh"});
    for (const auto& [meter, kWh] : monthly.items()) {
      const auto price = price_of(site, meter);
      if (!price || !kWh.is_number()) continue;
      cost += *price * kWh.get<double>();
      is_known = true;
    }
    list.push_back({{"key", at(addition, {"key"})},
                    {"title", at(addition, {"title"})},
                    {"probability", at(addition, {"probability"})},
                    {"monthly_kWh", monthly},
                    {"money_month", is_known ? results::number(cost) : Json(nullptr)}});
  }
  return list;
}

}  // namespace

Json job_summary(const SiteConfig& site, JobKind kind, const JobOutcome& outcome) {
  const Json document = Json::parse(outcome.result.document, nullptr, /*allow_exceptions=*/false);
  if (kind == JobKind::diagnosis) {
    return {{"outcome", at(document, {"outcome"})},
            {"most_likely", at(document, {"most_likely"})},
            {"currency", site.tariff.currency},
            {"named", named_of(site, document)}};
  }
  Json summary = {{"model", at(document, {"model"})}, {"status", at(document, {"status"})},
                  {"currency", site.tariff.currency}, {"outputs", outputs_of(site, document)},
                  {"alarms", Json::array()},          {"meter_changes", Json::array()}};
  if (const auto& drift = outcome.result.drift) {
    summary["alarms"] = results::alarms_json(*drift);
    summary["meter_changes"] = results::changed_meters_json(*drift);
  }
  return summary;
}

}  // namespace recald::daemon
