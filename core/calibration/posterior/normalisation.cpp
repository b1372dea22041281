#include "core/calibration/posterior/normalisation.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "core/display/id_words.hpp"
#include "core/text/number_text.hpp"

namespace recald::calibration {
namespace {

/// Columns of one output in a design's outputs: (runs x months).
auto block_of(const Eigen::MatrixXd& design_outputs, std::size_t output, int months) {
  return design_outputs.middleCols(static_cast<Eigen::Index>(output) * months, months);
}

/// Mean and sum of squares of normalised values, over all measured outputs.
double pooled_variance(const Eigen::MatrixXd& design_outputs,
                       std::span<const OutputMeasurements> outputs,
                       const std::vector<OutputScale>& scales, int months) {
  double sum = 0.0;
  double count = 0.0;
  const auto for_each_block = [&](const auto& body) {
    for (std::size_t k = 0; k < outputs.size(); ++k) {
      if (outputs[k].measured_months() == 0) continue;
      body((block_of(design_outputs, k, months).array() - scales[k].min) / scales[k].range());
    }
  };
  for_each_block([&](const auto& values) {
    sum += values.sum();
    count += static_cast<double>(values.size());
  });
  const double mean = sum / count;
  double squares = 0.0;
  for_each_block([&](const auto& values) { squares += (values - mean).square().sum(); });
  return squares / (count - 1.0);
}

/// Beyond the nearer end of the runs, as a share of it.
double beyond(const OutOfRange& month) {
  const double end = month.value > month.high ? month.high : month.low;
  return (month.value - end) / std::abs(end);
}

/// "July 2021 (+31 %)"
std::string month_beyond(const OutOfRange& month, std::span<const std::string> month_names) {
  const std::string text = display::month_words(month_names[static_cast<std::size_t>(month.month)]);
  // Beyond ten times the runs a percentage says nothing: they have almost nothing there.
  if (!(std::abs(beyond(month)) < 10.0)) return text;
  return text + " (" + signed_percent_text(beyond(month)) + ")";
}

Finding out_of_range(const std::vector<OutOfRange>& months, const OutputMeasurements& output,
                     std::span<const std::string> month_names, FindingKind kind) {
  const auto worst = std::ranges::max_element(
      months, {}, [](const OutOfRange& month) { return std::abs(beyond(month)); });
  const int measured = output.measured_months();
  std::string sentence = display::capitalised(display::output_words(output.name)) + ": " +
                         std::to_string(months.size()) + " of " + std::to_string(measured) +
                         (months.size() == 1 ? " months is outside " : " months are outside ");
  sentence +=
      kind == FindingKind::range_fail ? "the model's runs of that month" : "all runs of the model";
  sentence += ", the worst " + month_beyond(*worst, month_names) + ".";
  std::string list;
  for (const OutOfRange& month : months) {
    list += (list.empty() ? "" : ", ") + month_beyond(month, month_names);
  }
  return {kind, output.name, std::move(sentence),
          "Outside: " + list +
              ". The calibration extrapolates there; widen the priors or correct the fixed inputs.",
          static_cast<double>(months.size()) / measured};
}

}  // namespace

int OutputMeasurements::measured_months() const {
  return static_cast<int>(
      std::count_if(values.begin(), values.end(), [](double v) { return !std::isnan(v); }));
}

Result<Normalisation> normalise_design(const Eigen::MatrixXd& design_outputs,
                                       std::span<const OutputMeasurements> outputs, int months) {
  assert(design_outputs.cols() == static_cast<Eigen::Index>(outputs.size()) * months);
  Normalisation normalisation{{}, 0.0};
  for (std::size_t k = 0; k < outputs.size(); ++k) {
    if (outputs[k].measured_months() == 0) {
      normalisation.scales.push_back({0.0, 1.0});
      continue;
    }
    const auto block = block_of(design_outputs, k, months);
    const OutputScale scale{block.minCoeff(), block.maxCoeff()};
    if (!(scale.range() > 0.0)) {
      return failure(ErrorCode::invalid_value,
                     "the model gives " + number_text(scale.min) + " " + outputs[k].unit + " for " +
                         outputs[k].name +
                         " in every run and month, so it cannot be calibrated against that meter; "
                         "check that the model has the meter's end uses");
    }
    normalisation.scales.push_back(scale);
  }
  normalisation.pooled_variance =
      pooled_variance(design_outputs, outputs, normalisation.scales, months);
  return normalisation;
}

RangeCheck check_range(const Eigen::MatrixXd& design_outputs,
                       std::span<const OutputMeasurements> outputs,
                       const Normalisation& normalisation) {
  RangeCheck check;
  for (std::size_t k = 0; k < outputs.size(); ++k) {
    const auto months = static_cast<int>(outputs[k].values.size());
    const auto block = block_of(design_outputs, k, months);
    const OutputScale& scale = normalisation.scales[k];
    for (int i = 0; i < months; ++i) {
      const double value = outputs[k].values[static_cast<std::size_t>(i)];
      if (std::isnan(value)) continue;
      const double low = block.col(i).minCoeff();
      const double high = block.col(i).maxCoeff();
      const int output = static_cast<int>(k);
      if (value < scale.min || value > scale.max) {
        check.extrapolation.push_back({output, i, value, scale.min, scale.max});
      }
      if (value < low || value > high) check.by_month.push_back({output, i, value, low, high});
    }
  }
  return check;
}

Findings range_findings(const RangeCheck& check, std::span<const OutputMeasurements> outputs,
                        std::span<const std::string> month_names) {
  Findings findings;
  const auto add = [&](const std::vector<OutOfRange>& all, FindingKind kind) {
    for (std::size_t k = 0; k < outputs.size(); ++k) {
      std::vector<OutOfRange> here;
      std::copy_if(all.begin(), all.end(), std::back_inserter(here),
                   [k](const OutOfRange& m) { return m.output == static_cast<int>(k); });
      if (here.empty()) continue;
      findings.push_back(out_of_range(here, outputs[k], month_names, kind));
    }
  };
  add(check.extrapolation, FindingKind::extrapolation);
  add(check.by_month, FindingKind::range_fail);
  return findings;
}

}  // namespace recald::calibration
