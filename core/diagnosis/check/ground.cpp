#include "core/diagnosis/check/ground.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

namespace recald::diagnosis {
namespace {

constexpr std::size_t kLeastGround = 100;
// If residuals spread more than this at the upper half of the levels than at the lower half, a
// meter uses the square-root scale.
constexpr double kSpreadRatio = 1.6;
// A mode that is only to show scales and noise may be a rough one.
constexpr FitOptions kRough{.iterations_max = 12, .small_gain = 10.0};
constexpr FitOptions kFine{.iterations_max = 40};  // the mode that everything is compared with
constexpr double kLeastNodeWeight = 1e-6;  // relative to the likeliest; below it nodes are ignored
// Possible sizes of the anonymous patterns, in units of a meter's mean; the likeliest is used.
constexpr std::array kPatternShares{0.02, 0.06, 0.15};

/// Root mean square of the residuals in the upper half of the modelled levels divided by that
/// in the lower half.
double spread_ratio(const Observations& observations, std::size_t meter,
                    const Eigen::VectorXd& residual, const Eigen::VectorXd& modelled) {
  const MeterRows& rows = observations.meters[meter];
  const auto n = static_cast<Eigen::Index>(rows.rows.size());
  std::vector<std::pair<double, double>> by_level;
  for (Eigen::Index i = rows.offset; i < rows.offset + n; ++i) {
    by_level.emplace_back(modelled[i], residual[i] * residual[i]);
  }
  std::ranges::sort(by_level);
  double low = 0.0;
  double high = 0.0;
  for (std::size_t i = 0; i < by_level.size(); ++i) {
    (2 * i < by_level.size() ? low : high) += by_level[i].second;
  }
  return std::sqrt(high / std::max(low, 1e-12));
}

/// The likeliest noise of one meter, over the possible sizes of its patterns.
Result<NoiseLevel> level_of(const MeterRows& meter, const Eigen::VectorXd& residual) {
  std::optional<LevelFit> best;
  for (const double share : kPatternShares) {
    auto fitted = TRY(fit_levels(residual, meter.design, std::max(meter.mean_kW, 1e-6), share,
                                 best ? std::optional{best->level} : std::nullopt));
    if (!best || fitted.log_density > best->log_density) best = fitted;
  }
  return best->level;
}

/// As above, near a given level and with its size of patterns.
Result<NoiseLevel> refined(const MeterRows& meter, const Eigen::VectorXd& residual,
                           const NoiseLevel& near) {
  const double mean = std::max(meter.mean_kW, 1e-6);
  auto fitted = TRY(fit_levels(residual, meter.design, mean, near.pattern_sd / mean, near));
  return fitted.level;
}

/// @param before  Levels of the previous round; empty in the first.
Result<std::vector<NoiseLevel>> levels_of(const Observations& observations,
                                          const Eigen::VectorXd& residual,
                                          const std::vector<NoiseLevel>& before) {
  std::vector<NoiseLevel> levels;
  for (std::size_t g = 0; g < observations.meters.size(); ++g) {
    const MeterRows& meter = observations.meters[g];
    const Eigen::VectorXd own =
        residual.segment(meter.offset, static_cast<Eigen::Index>(meter.rows.size()));
    auto level = TRY(before.empty() ? level_of(meter, own) : refined(meter, own, before[g]));
    levels.push_back(level);
  }
  return levels;
}

/// Nearly white: with much slow structure, the errors of a poor start would be
/// absorbed by the noise.
/// @param residual  (n) sets the strength of the white noise; empty: 10 % of each mean.
NoiseNode search_noise(const Observations& observations, const Eigen::VectorXd& residual) {
  constexpr double kFirst = 0.1;
  constexpr double kLeast = 0.01;
  std::vector<NoiseLevel> levels;
  for (const MeterRows& meter : observations.meters) {
    const double mean = std::max(meter.mean_kW, 1e-6);
    const auto n = static_cast<Eigen::Index>(meter.rows.size());
    const double white = residual.size() == 0 || n == 0
                             ? kFirst * mean
                             : residual.segment(meter.offset, n).norm() / std::sqrt(n);
    levels.push_back({.structure_sd = 0.02 * mean,
                      .correlation_h = 48.0,
                      .white_sd = std::max(white, kLeast * mean),
                      .pattern_sd = 0.005 * mean});
  }
  return std::move(noise_grid(observations, levels, false).front());
}

void set_gates(Observations& observations, const Eigen::VectorXd& residual,
               std::span<const NoiseLevel> levels) {
  std::vector<Eigen::VectorXd> residuals;
  for (const MeterRows& meter : observations.meters) {
    residuals.push_back(
        residual.segment(meter.offset, static_cast<Eigen::Index>(meter.rows.size())));
  }
  std::vector<GateInput> inputs;
  for (std::size_t g = 0; g < observations.meters.size(); ++g) {
    inputs.push_back({observations.meters[g].design, residuals[g], levels[g]});
  }
  const auto gates = choose_gates(inputs);
  for (std::size_t g = 0; g < gates.size(); ++g) observations.meters[g].design.gated = gates[g];
}

/// From the residuals without patterns and usual errors.
void set_spreads(const SiteProblem& site, const Ground& ground, std::vector<MeterScale>& scales) {
  const NoiseNode& node = ground.grid[static_cast<std::size_t>(ground.none.best_node)];
  for (std::size_t g = 0; g < scales.size(); ++g) {
    const MeterRows& meter = ground.fit.meters[g];
    const Eigen::VectorXd own =
        ground.none.residual.segment(meter.offset, static_cast<Eigen::Index>(meter.rows.size()));
    scales[g].spread =
        spread_of(site, meter, own - meter.design.patterns * node.meters[g].pattern_mean(own));
  }
}

/// With nearly white noise and no usual errors, so that the parameters first explain all they can.
Ground plain_ground(const SiteProblem& site) {
  Ground ground;
  ground.fit =
      observe(site, parts_of(site, {Role::fit}), std::vector<MeterScale>(site.meters.size()));
  ground.errors = UsualErrors{}.columns(ground.fit);
  ground.search = search_noise(ground.fit, {});
  ground.grid = {ground.search};
  return ground;
}

Result<void> require_parts(const SiteProblem& site, const Observations& fit) {
  for (std::size_t g = 0; g < site.meters.size(); ++g) {
    const std::size_t measured = fit.meters[g].rows.size();
    if (measured >= kLeastGround) continue;
    return failure(
        ErrorCode::not_enough_data,
        "meter '" + site.meters[g].id + "' has " + std::to_string(measured) +
            " measured four-hour parts in the months to fit, but a diagnosis needs 100 per meter; "
            "leave the meter out of the model's outputs or provide more readings");
  }
  return {};
}

/// Finds the meters whose errors are proportional to their level.
void set_levels_scale(const Ground& ground, std::vector<MeterScale>& scales) {
  const Eigen::VectorXd modelled = ground.fit.stack(ground.none.parts_kW);
  for (std::size_t g = 0; g < scales.size(); ++g) {
    if (spread_ratio(ground.fit, g, ground.none.residual, modelled) > kSpreadRatio) {
      scales[g].levels = ResidualScale::square_root;
    }
  }
}

/// The usual errors at the current mode: base parameters move when errors are added, and the
/// errors' shapes with them.
void draw_errors(Predictor& predictor, const SiteProblem& site, Ground& ground) {
  ground.usual =
      std::make_shared<const UsualErrors>(UsualErrors::draw(predictor, site, ground.none.theta));
  ground.errors = ground.usual->columns(ground.fit);
  const auto q = std::ssize(site.parameters);
  Eigen::VectorXd scores = Eigen::VectorXd::Zero(q + ground.usual->count());
  scores.head(q) = ground.none.scores.head(q);
  // The same effects as before, drawn elsewhere, are needed in about the same amounts.
  if (ground.none.scores.size() == scores.size()) scores = ground.none.scores;
  ground.none.scores = std::move(scores);
}

/// Noise of the residuals at the current mode, for the search and for scoring.
/// @param last  Start near the known levels, and use a whole grid.
Result<void> learn_noise(Ground& ground, bool last, const ForEachIndex& executor) {
  const Eigen::VectorXd gap = ground.fit.measured - ground.fit.stack(ground.none.parts_kW);
  ground.search = search_noise(ground.fit, gap);
  const Eigen::VectorXd left = gap - ground.errors * ground.none.scores.tail(ground.errors.cols());
  ground.levels =
      TRY(levels_of(ground.fit, left, last ? ground.levels : std::vector<NoiseLevel>{}));
  set_gates(ground.fit, left, ground.levels);
  ground.grid = noise_grid(ground.fit, ground.levels, last, executor);
  ground.reference_node = ground.grid.size() / 2;
  return {};
}

/// Keeps the nodes that matter; the likeliest becomes the reference.
void keep_likely_nodes(Ground& ground) {
  const Eigen::VectorXd weights = ground.none.node_weights;
  std::vector<NoiseNode> likely;
  std::vector<double> kept;
  for (Eigen::Index i = 0; i < weights.size(); ++i) {
    if (weights[i] < kLeastNodeWeight * weights.maxCoeff()) continue;
    if (i == ground.none.best_node) ground.reference_node = likely.size();
    likely.push_back(std::move(ground.grid[static_cast<std::size_t>(i)]));
    kept.push_back(weights[i]);
  }
  ground.grid = std::move(likely);
  ground.none.node_weights = Eigen::Map<const Eigen::VectorXd>(kept.data(), std::ssize(kept));
  ground.none.best_node = static_cast<Eigen::Index>(ground.reference_node);
}

/// Usual errors, noise and mode once each, in this order.
Result<void> learn(Predictor& predictor, const SiteProblem& site, bool last, Ground& ground) {
  draw_errors(predictor, site, ground);
  if (auto learnt = learn_noise(ground, last, predictor.executor()); !learnt) return learnt;
  ground.none = TRY(fit_jointly(predictor, ground.context(site), Candidate{}, ground.none.scores,
                                last ? kFine : kRough));
  if (!last) return {};
  keep_likely_nodes(ground);
  return take_usual_errors(ground.context(site), ground.none);
}

}  // namespace

Result<Ground> lay_ground(Predictor& predictor, const SiteProblem& site,
                          const Eigen::VectorXd& start) {
  Ground ground = plain_ground(site);
  TRY(require_parts(site, ground.fit));
  ground.none = TRY(fit_jointly(predictor, ground.context(site), Candidate{}, start, kRough));
  std::vector<MeterScale> scales(site.meters.size());
  set_levels_scale(ground, scales);

  for (const bool last : {false, true}) {
    ground.fit = observe(site, parts_of(site, {Role::fit}), scales);
    TRY(learn(predictor, site, last, ground));
    if (!last) set_spreads(site, ground, scales);
  }
  ground.select = observe(site, parts_of(site, {Role::select}), scales);
  ground.show = observe(site, parts_of(site, {Role::show}), scales);
  return ground;
}

Result<Ground> lay_next_ground(Predictor& predictor, const SiteProblem& site, const Ground& before,
                               const JointFit& found) {
  Ground ground = before;
  ground.none = found;
  ground.none.scores.conservativeResize(std::ssize(site.parameters) + found.usual.size());
  TRY(learn(predictor, site, true, ground));
  return ground;
}

}  // namespace recald::diagnosis
