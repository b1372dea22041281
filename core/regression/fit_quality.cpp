#include "core/regression/fit_quality.hpp"

#include <algorithm>
#include <cmath>
#include <string_view>

#include "core/statistics/quantile.hpp"

namespace recald::regression {
namespace {

/// Sums that make an R2, over as many blocks (runs x months) as are added.
struct Squares {
  double total = 0.0;
  double within_months = 0.0;
  double fitted = 0.0;
  double left_out = 0.0;

  void add(const Eigen::MatrixXd& truth, double mean, const Eigen::MatrixXd& fitted_values,
           const Eigen::MatrixXd& left_out_values) {
    total += (truth.array() - mean).square().sum();
    within_months += (truth.rowwise() - truth.colwise().mean()).squaredNorm();
    fitted += (truth - fitted_values).squaredNorm();
    left_out += (truth - left_out_values).squaredNorm();
  }

  [[nodiscard]] FitQuality quality() const {
    // An output that only the weather moves has nothing to be explained within months.
    const double within = within_months > 0.0 ? 1.0 - left_out / within_months : 0.0;
    return {1.0 - fitted / total, 1.0 - left_out / total, within};
  }
};

/// The part of the name before "daily" or "peak", without the underscore between.
std::string before(std::string_view name, std::size_t marker) {
  name = name.substr(0, marker);
  while (!name.empty() && name.back() == '_') name.remove_suffix(1);
  return std::string(name);
}

}  // namespace

std::vector<int> MeterOutputs::existing() const {
  std::vector<int> outputs;
  for (const int k : {consumption, peak}) {
    if (k >= 0) outputs.push_back(k);
  }
  return outputs;
}

std::vector<MeterOutputs> group_by_meter(const std::vector<std::string>& outputs) {
  std::vector<MeterOutputs> meters;
  for (std::size_t k = 0; k < outputs.size(); ++k) {
    const std::string& name = outputs[k];
    const auto daily = name.rfind("daily");
    const auto peak = name.rfind("peak");
    const bool is_peak = peak != std::string::npos && daily == std::string::npos;
    const bool paired = is_peak || daily != std::string::npos;
    const std::string meter = paired ? before(name, is_peak ? peak : daily) : name;
    auto slot = [is_peak](MeterOutputs& m) -> int& { return is_peak ? m.peak : m.consumption; };
    auto found = std::find_if(meters.begin(), meters.end(), [&](MeterOutputs& m) {
      return paired && m.meter == meter && slot(m) < 0;
    });
    if (found == meters.end()) found = meters.insert(meters.end(), {.meter = meter});
    slot(*found) = static_cast<int>(k);
  }
  return meters;
}

DesignQuality assess_fit(const DesignData& design, const std::vector<ColumnScale>& scales,
                         const Eigen::MatrixXd& fitted, const Eigen::MatrixXd& left_out) {
  const Eigen::Index months = design.month_count();
  const Eigen::MatrixXd truth = normalise_outputs(design, scales);
  const auto squares_of = [&](const std::vector<int>& outputs) {
    // About one mean for all: a meter's two types together, as one regression sees them.
    double sum = 0.0;
    for (const int k : outputs) sum += truth.middleCols(k * months, months).sum();
    const double mean = sum / static_cast<double>(static_cast<Eigen::Index>(outputs.size()) *
                                                  months * design.runs());
    Squares squares;
    for (const int k : outputs) {
      squares.add(truth.middleCols(k * months, months), mean, fitted.middleCols(k * months, months),
                  left_out.middleCols(k * months, months));
    }
    return squares;
  };

  DesignQuality quality;
  std::vector<int> all;
  for (std::size_t k = 0; k < design.outputs.size(); ++k) {
    all.push_back(static_cast<int>(k));
    const Squares squares = squares_of({static_cast<int>(k)});
    const double cells = static_cast<double>(design.runs() * months);
    const auto of_output = Eigen::seqN(static_cast<Eigen::Index>(k) * months, months);
    const Eigen::VectorXd by_month =
        (truth(Eigen::all, of_output) - left_out(Eigen::all, of_output)).colwise().squaredNorm() /
        static_cast<double>(design.runs());
    quality.outputs.push_back({design.outputs[k], squares.quality(),
                               std::sqrt(squares.left_out / cells) * scales[k].range(),
                               by_month.cwiseSqrt() * scales[k].range()});
  }
  for (const MeterOutputs& meter : group_by_meter(design.outputs)) {
    quality.meters.push_back({meter.meter, squares_of(meter.existing()).quality()});
  }
  quality.all = squares_of(all).quality();
  return quality;
}

std::vector<CheckedOutput> check_predictions(const DesignData& check,
                                             const Eigen::MatrixXd& predicted) {
  std::vector<CheckedOutput> outputs;
  const Eigen::Index months = check.month_count();
  for (std::size_t k = 0; k < check.outputs.size(); ++k) {
    const Eigen::MatrixXd truth = check.output(static_cast<Eigen::Index>(k));
    const Eigen::MatrixXd error =
        predicted.middleCols(static_cast<Eigen::Index>(k) * months, months) - truth;
    const Eigen::RowVectorXd means = truth.colwise().mean();
    const Eigen::RowVectorXd spreads = (truth.rowwise() - means).colwise().squaredNorm();
    const Eigen::RowVectorXd errors = error.colwise().squaredNorm();
    std::vector<double> r2;
    for (Eigen::Index i = 0; i < months; ++i) {
      r2.push_back(spreads[i] > 0.0 ? 1.0 - errors[i] / spreads[i] : 1.0);
    }
    const auto worst = std::ranges::min_element(r2) - r2.begin();
    CheckedOutput output{
        .name = check.outputs[k],
        .cvrmse = std::sqrt(error.squaredNorm() / static_cast<double>(error.size())) / truth.mean(),
        .r2_median_month = 0.0,
        .r2_worst_month = r2[static_cast<std::size_t>(worst)],
        .worst_month = check.months[static_cast<std::size_t>(worst)],
        .error_of_worst =
            std::sqrt(errors[worst] / static_cast<double>(check.runs())) / means[worst]};
    std::ranges::sort(r2);
    output.r2_median_month = quantile_of_sorted(r2, 0.5);
    outputs.push_back(std::move(output));
  }
  return outputs;
}

Eigen::MatrixXd normalise_outputs(const DesignData& design,
                                  const std::vector<ColumnScale>& scales) {
  Eigen::MatrixXd normalised(design.values.rows(), design.values.cols());
  const Eigen::Index months = design.month_count();
  for (std::size_t k = 0; k < scales.size(); ++k) {
    const auto first = static_cast<Eigen::Index>(k) * months;
    normalised.middleCols(first, months) =
        (design.values.middleCols(first, months).array() - scales[k].min) / scales[k].range();
  }
  return normalised;
}

}  // namespace recald::regression
