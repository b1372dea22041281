#include "core/drift/prequential.hpp"

#include <cmath>
#include <utility>

namespace recald::drift {
namespace {

/// A building that has become another one uses by another factor, and nobody knows which.
constexpr LevelForecast::Prior kLevelAfterAChange{.level_sd = 0.3};

/// From the normalised scale to the output's unit.
Forecast in_units(Forecast forecast, const calibration::OutputScale& scale) {
  forecast.means = scale.min + scale.range() * forecast.means.array();
  forecast.sds *= scale.range();
  return forecast;
}

ForecastRecord record_of(const Forecast& forecast, double measured) {
  return {.mean = forecast.mean(),
          .sd = forecast.sd(),
          .q05 = forecast.quantile(0.05),
          .q50 = forecast.quantile(0.5),
          .q95 = forecast.quantile(0.95),
          .measured = measured,
          .surprise = surprise_of(forecast, measured)};
}

}  // namespace

Prequential::Prequential(SequentialCalibration calibration, calibration::PosteriorData all,
                         std::vector<LevelOutput> levels, const WatchOptions& options)
    : calibration_(std::move(calibration)),
      all_(std::move(all)),
      spreads_(all_.scales.size()),
      watch_(static_cast<int>(all_.scales.size()), options) {
  for (LevelOutput& level : levels) levels_.push_back({std::move(level), LevelForecast{}});
}

Result<void> Prequential::evaluate_points(PrequentialMonth& record) {
  if (!calibration_.has_begun()) return {};
  const auto forecasts = TRY(calibration_.forecast(record.month));
  std::size_t next = 0;  // forecasts come in the order of the month's points
  for (std::size_t i = 0; i < all_.points.size(); ++i) {
    if (all_.points[i].month != record.month) continue;
    const auto output = static_cast<std::size_t>(all_.points[i].output);
    const calibration::OutputScale& scale = all_.scales[output];
    const double measured = scale.min + scale.range() * all_.values(static_cast<Eigen::Index>(i));
    const Forecast forecast = in_units(forecasts[next++], scale);
    const double level = forecast.mean() / scale.max;
    record.outputs[output] = record_of(spreads_[output].adapt(forecast, level), measured);
    spreads_[output].take(level, standardised_surprise(forecast, measured));
  }
  return {};
}

void Prequential::evaluate_levels(PrequentialMonth& record) {
  const auto month = static_cast<std::size_t>(record.month);
  for (Level& level : levels_) {
    const double modelled = level.output.modelled[month];
    const double measured = level.output.measured[month];
    if (std::isnan(measured)) continue;
    record.outputs[static_cast<std::size_t>(level.output.output)] =
        record_of(level.forecast.forecast(modelled), measured);
    level.forecast.take(modelled, measured);
  }
}

Result<void> Prequential::begin_at(int month, const std::function<bool()>& proceed) {
  if (auto begun = calibration_.begin_at(month, proceed); !begun) return begun;
  for (Level& level : levels_) {
    level.forecast = LevelForecast{kLevelAfterAChange};
    for (int i = month; i <= last_; ++i) {
      const auto at = static_cast<std::size_t>(i);
      if (std::isnan(level.output.measured[at])) continue;
      level.forecast.take(level.output.modelled[at], level.output.measured[at]);
    }
  }
  watch_.begin_anew();
  return {};
}

std::vector<LevelOutput> Prequential::levels() const {
  std::vector<LevelOutput> levels;
  for (const Level& level : levels_) levels.push_back(level.output);
  return levels;
}

Result<void> Prequential::set_aside(int output, int since, const std::function<bool()>& proceed) {
  if (auto aside = calibration_.set_aside(output, since, proceed); !aside) return aside;
  std::erase_if(levels_, [&](const Level& level) { return level.output.output == output; });
  all_ = select_points(all_, rows_without(all_, output, since));
  return {};
}

Result<PrequentialMonth> Prequential::step(int month, const std::function<bool()>& proceed) {
  PrequentialMonth record{.month = month, .outputs = {}, .taken = {.month = month}, .alarms = {}};
  record.outputs.resize(all_.scales.size());
  TRY(evaluate_points(record));
  record.taken = TRY(calibration_.take(month, proceed));
  evaluate_levels(record);
  std::vector<std::optional<double>> surprises;
  for (const auto& output : record.outputs) {
    surprises.push_back(output ? std::optional{output->surprise.standardised} : std::nullopt);
  }
  record.alarms = watch_.observe(month, surprises);
  last_ = month;
  return record;
}

}  // namespace recald::drift
