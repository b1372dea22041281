#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "adapters/views/diagnosis/diagnosis_page.hpp"
#include "adapters/views/diagnosis/diagnosis_sections.hpp"
#include "adapters/views/frame/format.hpp"
#include "adapters/views/frame/script_json.hpp"

namespace recald::views {
namespace {

using nlohmann::json;

constexpr int kDigits = 3;  // more would not be visible in a colour or a point
constexpr std::array<double, 9> kScales = {0.05, 0.1, 0.15, 0.2, 0.3, 0.4, 0.5, 0.75, 1.0};
constexpr double kShareWithinScale = 0.98;

const char* use_text(diagnosis::Role use) {
  switch (use) {
    case diagnosis::Role::fit:
    case diagnosis::Role::buffer:
      break;
    case diagnosis::Role::select:
      return "choose";
    case diagnosis::Role::show:
      return "kept";
  }
  return "fit";
}

const char* kind_text(CandidateKind kind) {
  switch (kind) {
    case CandidateKind::effect:
      break;
    case CandidateKind::none:
      return "none";
    case CandidateKind::unknown:
      return "unknown";
  }
  return "effect";
}

json rows_json(const Eigen::ArrayXXd& cells) {
  json rows = json::array();
  for (Eigen::Index i = 0; i < cells.rows(); ++i) {
    const Eigen::ArrayXd row = cells.row(i);
    rows.push_back(json_numbers(row, kDigits));
  }
  return rows;
}

json map_json(const diagnosis::ResidualMap& map) {
  return {{"month", rows_json(map.by_month)}, {"temperature", rows_json(map.by_temperature)}};
}

json maps_json(const MeterMaps& maps) {
  return {{"label", maps.meter},
          {"scale", colour_scale(maps)},
          {"before", map_json(maps.before)},
          {"after", maps.after ? map_json(*maps.after) : json(nullptr)}};
}

json steps_json(const DiagnosisData& data) {
  json labels = json::array();
  for (const GapStep& step : data.steps) labels.push_back(step.label);
  json measures = json::array();
  for (const GapMeasure& measure : gap_measures()) {
    json meters = json::array();
    for (std::size_t g = 0; g < data.meters.size(); ++g) {
      json values = json::array();
      for (const GapStep& step : data.steps) {
        values.push_back(json_number(measure.value(data.steps.front().gaps[g], step.gaps[g])));
      }
      meters.push_back({{"label", data.meters[g]}, {"values", values}});
    }
    measures.push_back(
        {{"label", measure.label}, {"percent", measure.is_share}, {"meters", meters}});
  }
  return {{"labels", labels}, {"measures", measures}};
}

json signature_json(const diagnosis::Signature& signature) {
  return {{"week", json_numbers(signature.by_part_of_week, kDigits)},
          {"temperature", json_numbers(signature.by_temperature, kDigits)}};
}

json effect_signature_json(const EffectSignature& signature) {
  return {{"effect", signature.effect},
          {"meter", signature.meter},
          {"residual", signature_json(signature.residual)},
          {"change", signature_json(signature.change)},
          {"alone", signature_json(signature.effect_alone)}};
}

}  // namespace

double colour_scale(const MeterMaps& maps) {
  std::vector<double> sizes;
  const auto collect = [&sizes](const Eigen::ArrayXXd& cells) {
    for (const double cell : cells.reshaped()) {
      if (std::isfinite(cell)) sizes.push_back(std::abs(cell));
    }
  };
  collect(maps.before.by_month);
  if (maps.after) collect(maps.after->by_month);
  if (sizes.empty()) return kScales.front();
  std::ranges::sort(sizes);
  const double wanted =
      sizes[static_cast<std::size_t>(kShareWithinScale * static_cast<double>(sizes.size() - 1))];
  const auto found = std::ranges::lower_bound(kScales, wanted);
  return found == kScales.end() ? kScales.back() : *found;
}

std::span<const GapMeasure> gap_measures() {
  using Gap = diagnosis::MeterGap;
  static constexpr std::array<GapMeasure, 3> kMeasures = {{
      {"Scatter day by day, CV(RMSE)", true,
       [](const Gap&, const Gap& gap) { return gap.cvrmse_daily; }},
      {"Scatter month by month, CV(RMSE)", true,
       [](const Gap&, const Gap& gap) { return gap.cvrmse_monthly; }},
      {"Log score a month, gained", false,
       [](const Gap& first, const Gap& gap) { return gap.log_score - first.log_score; }},
  }};
  return kMeasures;
}

std::string diagnosis_figure_json(const DiagnosisData& data) {
  json months = json::array();
  for (const metering::Month month : data.months) months.push_back(month_key(month));
  json uses = json::array();
  for (const diagnosis::Role use : data.uses) uses.push_back(use_text(use));
  json maps = json::array();
  for (const MeterMaps& meter : data.maps) maps.push_back(maps_json(meter));
  json candidates = json::array();
  for (const CandidateBar& bar : data.candidates) {
    candidates.push_back({{"label", bar.label},
                          {"kind", kind_text(bar.kind)},
                          {"probability", json_number(bar.probability)}});
  }
  json signatures = json::array();
  for (const EffectSignature& s : data.signatures) signatures.push_back(effect_signature_json(s));
  return script_safe_text({{"months", months},
                           {"uses", uses},
                           {"temperatureLimits", json_numbers(data.temperature_limits)},
                           {"temperatureUnit", data.temperature_unit},
                           {"maps", maps},
                           {"candidates", candidates},
                           {"steps", data.steps.empty() ? json(nullptr) : steps_json(data)},
                           {"signatures", signatures}});
}

}  // namespace recald::views
