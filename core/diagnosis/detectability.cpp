#include "core/diagnosis/detectability.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "core/absent.hpp"
#include "core/diagnosis/check/ground.hpp"
#include "core/diagnosis/naming/signature_fit.hpp"

namespace recald::diagnosis {
namespace {

using Averaging = Eigen::SparseMatrix<double, Eigen::RowMajor>;

Eigen::Index count_of(const MeterRows& meter) {
  return static_cast<Eigen::Index>(meter.rows.size());
}

/// P: means over the rows of a group, each row weighted by the hours of its part.
Averaging averaging_of(const SiteProblem& site, const MeterRows& meter,
                       int (*group)(const DayPart&)) {
  std::vector<Eigen::Triplet<double>> weights;
  std::vector<double> hours;
  int last = 0;
  for (std::size_t i = 0; i < meter.rows.size(); ++i) {
    const DayPart& part = site.day_parts.parts[static_cast<std::size_t>(meter.rows[i])];
    if (hours.empty() || group(part) != last) hours.push_back(0.0);
    last = group(part);
    hours.back() += part.hours;
    weights.emplace_back(static_cast<int>(hours.size()) - 1, static_cast<int>(i), part.hours);
  }
  Averaging averaging(static_cast<Eigen::Index>(hours.size()), count_of(meter));
  averaging.setFromTriplets(weights.begin(), weights.end());
  for (Eigen::Index k = 0; k < averaging.rows(); ++k) {
    averaging.row(k) /= hours[static_cast<std::size_t>(k)];
  }
  return averaging;
}

/// K_u X: the sum over earlier and later points decays from each to the next, so no n x n
/// matrix is needed.
Eigen::MatrixXd structure_times(const BlockDesign& design, const NoiseLevel& level,
                                const Eigen::MatrixXd& columns) {
  const Eigen::Index n = columns.rows();
  Eigen::MatrixXd product = columns;
  Eigen::RowVectorXd earlier = Eigen::RowVectorXd::Zero(columns.cols());
  Eigen::RowVectorXd later = earlier;
  const auto decay = [&](Eigen::Index i) {
    return std::exp(-(design.times_h[i] - design.times_h[i - 1]) / level.correlation_h);
  };
  for (Eigen::Index i = 1; i < n; ++i) {
    earlier = decay(i) * (earlier + columns.row(i - 1));
    product.row(i) += earlier;
    later = decay(n - i) * (later + columns.row(n - i));
    product.row(n - i - 1) += later;
  }
  return level.structure_sd * level.structure_sd * product;
}

/// P Sigma P' (groups x groups), from the definition of the noise.
Eigen::MatrixXd averaged_covariance(const BlockDesign& design, const NoiseLevel& level,
                                    const Averaging& averaging) {
  Eigen::VectorXd white =
      Eigen::VectorXd::Constant(averaging.cols(), level.white_sd * level.white_sd);
  for (std::size_t i = 0; i < design.gated.size(); ++i) {
    if (design.gated[i]) white[static_cast<Eigen::Index>(i)] *= gated_variance_factor;
  }
  const Eigen::MatrixXd spread = averaging.transpose();  // P' (n x groups)
  const Eigen::MatrixXd patterns = level.pattern_sd * (averaging * design.patterns);
  Eigen::MatrixXd covariance = averaging * structure_times(design, level, spread);
  covariance += averaging * (white.asDiagonal() * spread);
  covariance += patterns * patterns.transpose();
  return covariance;
}

/// Factor of I + J' Sigma^-1 J.
Result<Eigen::LLT<Eigen::MatrixXd>> posterior_factor(const Eigen::MatrixXd& information) {
  const Eigen::Index q = information.rows();
  Eigen::LLT<Eigen::MatrixXd> factor(Eigen::MatrixXd::Identity(q, q) + information);
  // Eigen accepts a NaN in its factorisation.
  if (factor.info() != Eigen::Success || !factor.matrixLLT().allFinite()) {
    return failure(ErrorCode::not_positive_definite,
                   "a sensitivity of the base model is not a finite number, so recald cannot tell "
                   "what the model could imitate");
  }
  return factor;
}

/// @param signal  s' Sigma^-1 s   @param imitated  J' Sigma^-1 s (q)
Visibility visibility_of(double signal, const Eigen::VectorXd& imitated,
                         const Eigen::LLT<Eigen::MatrixXd>& posterior) {
  const double absorbed = posterior.matrixL().solve(imitated).squaredNorm();
  const double left = std::max(signal - absorbed, 0.0);
  return {.detectability = std::sqrt(left),
          .unprojected = std::sqrt(signal),
          .absorbed_share = signal > 0.0 ? 1.0 - left / signal : 0.0};
}

}  // namespace

Result<FootprintGauge> FootprintGauge::calibrate(const SiteProblem& twin) {
  Predictor predictor{twin};
  const SignatureReader reader(twin);
  const auto ground =
      TRY(lay_ground(predictor, twin, fit_signatures(twin, reader, predictor).scores));
  const auto node = static_cast<std::size_t>(ground.none.best_node);
  return make(twin, ground.fit, ground.grid[node], ground.none.jacobian);
}

Result<FootprintGauge> FootprintGauge::make(const SiteProblem& twin,
                                            const Observations& observations,
                                            const NoiseNode& noise,
                                            const Eigen::MatrixXd& jacobian) {
  assert(noise.meters.size() == observations.meters.size());  // every meter has rows
  assert(jacobian.rows() == observations.count());
  FootprintGauge gauge(twin);
  gauge.observations_ = observations;
  gauge.noise_ = noise;
  gauge.solved_jacobian_.resize(jacobian.rows(), jacobian.cols());
  for (std::size_t g = 0; g < noise.meters.size(); ++g) {
    const MeterRows& meter = observations.meters[g];
    gauge.solved_jacobian_.middleRows(meter.offset, count_of(meter)) =
        noise.meters[g].solve(jacobian.middleRows(meter.offset, count_of(meter)));
  }
  gauge.posterior_ = TRY(posterior_factor(jacobian.transpose() * gauge.solved_jacobian_));

  gauge.day_ = TRY(gauge.coarse_grain(jacobian, [](const DayPart& p) { return p.day_index; }));
  gauge.month_ = TRY(gauge.coarse_grain(jacobian, [](const DayPart& p) { return p.month; }));
  return gauge;
}

Result<FootprintGauge::CoarseGrain> FootprintGauge::coarse_grain(
    const Eigen::MatrixXd& jacobian, int (*group)(const DayPart&)) const {
  CoarseGrain grain;
  Eigen::MatrixXd information = Eigen::MatrixXd::Zero(jacobian.cols(), jacobian.cols());
  for (std::size_t g = 0; g < observations_.meters.size(); ++g) {
    const MeterRows& meter = observations_.meters[g];
    Averages averages{averaging_of(*twin_, meter, group), {}, {}};
    // With white noise in every row the matrix can always be factorised.
    averages.covariance.compute(
        averaged_covariance(meter.design, noise_.meters[g].level(), averages.averaging));
    averages.jacobian = averages.averaging * jacobian.middleRows(meter.offset, count_of(meter));
    averages.covariance.matrixL().solveInPlace(averages.jacobian);
    information += averages.jacobian.transpose() * averages.jacobian;
    grain.meters.push_back(std::move(averages));
  }
  grain.posterior = TRY(posterior_factor(information));
  return grain;
}

Result<Detectability> FootprintGauge::measure(
    const Eigen::Ref<const Eigen::ArrayXXd>& footprint_kW) const {
  assert(footprint_kW.rows() == twin_->measured_kW.rows());
  assert(footprint_kW.cols() == twin_->measured_kW.cols());
  // Averaging is linear, so parts of (twin + s) minus parts of the twin equal those of s, with
  // the twin's mask.
  Eigen::ArrayXXd counted = twin_->measured_kW.isFinite().select(footprint_kW, kAbsent);
  const Eigen::ArrayXXd whole_kW = measured_parts(twin_->day_parts, counted);
  ProfileReading{*twin_}.take_usual_day_from(counted);
  const Eigen::ArrayXXd parts_kW = measured_parts(twin_->day_parts, counted);
  const Eigen::VectorXd footprint =
      observations_.stack(twin_->measured_parts_kW + parts_kW) - observations_.measured;
  if (!footprint.allFinite()) {
    return failure(ErrorCode::not_finite,
                   "the footprint has a value that is not a finite number at a time when its meter "
                   "was measured");
  }
  const Visibility block = at_block(footprint);
  return Detectability{.month = at(month_, footprint),
                       .day = at(day_, footprint),
                       .block = block,
                       .d_star = block.detectability / null_score_spread,
                       .meters = moves(whole_kW)};
}

Visibility FootprintGauge::at_block(const Eigen::VectorXd& footprint) const {
  const GramSystem system = noise_.gram(observations_, footprint);
  return visibility_of(system.gram(0, 0), solved_jacobian_.transpose() * footprint, posterior_);
}

Visibility FootprintGauge::at(const CoarseGrain& grain, const Eigen::VectorXd& footprint) const {
  double signal = 0.0;
  Eigen::VectorXd imitated = Eigen::VectorXd::Zero(solved_jacobian_.cols());
  for (std::size_t g = 0; g < grain.meters.size(); ++g) {
    const Averages& averages = grain.meters[g];
    const MeterRows& meter = observations_.meters[g];
    const Eigen::VectorXd whitened = averages.covariance.matrixL().solve(
        Eigen::VectorXd(averages.averaging * footprint.segment(meter.offset, count_of(meter))));
    signal += whitened.squaredNorm();
    imitated += averages.jacobian.transpose() * whitened;
  }
  return visibility_of(signal, imitated, grain.posterior);
}

std::vector<MeterMove> FootprintGauge::moves(const Eigen::ArrayXXd& parts_kW) const {
  std::vector<MeterMove> moves;
  for (std::size_t g = 0; g < observations_.meters.size(); ++g) {
    const auto column = static_cast<Eigen::Index>(g);
    double whole_kWh = 0.0;
    double net_kWh = 0.0;
    double moved_kWh = 0.0;
    for (const Eigen::Index row : observations_.meters[g].rows) {
      const int hours = twin_->day_parts.parts[static_cast<std::size_t>(row)].hours;
      whole_kWh += hours * twin_->measured_parts_kW(row, column);
      net_kWh += hours * parts_kW(row, column);
      moved_kWh += hours * std::abs(parts_kW(row, column));
    }
    const double scale = whole_kWh > 0.0 ? 1.0 / whole_kWh : 0.0;
    moves.push_back({net_kWh * scale, moved_kWh * scale});
  }
  return moves;
}

}  // namespace recald::diagnosis
