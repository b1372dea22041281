#include "core/drift/prequential.hpp"

#include <utility>

namespace recald::drift {
namespace {

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
                         const WatchOptions& options)
    : calibration_(std::move(calibration)),
      all_(std::move(all)),
      watch_(static_cast<int>(all_.scales.size()), options) {}

Result<PrequentialMonth> Prequential::step(int month, const std::function<bool()>& proceed) {
  PrequentialMonth record{.month = month, .outputs = {}, .taken = {.month = month}, .alarms = {}};
  record.outputs.resize(all_.scales.size());
  std::vector<std::optional<double>> surprises(all_.scales.size());
  if (calibration_.has_begun()) {
    const auto forecasts = calibration_.forecast(month);
    if (!forecasts) return tl::unexpected(forecasts.error());
    std::size_t next = 0;  // forecasts come in the order of the month's points
    for (std::size_t i = 0; i < all_.points.size(); ++i) {
      if (all_.points[i].month != month) continue;
      const auto output = static_cast<std::size_t>(all_.points[i].output);
      const calibration::OutputScale& scale = all_.scales[output];
      const double measured = scale.min + scale.range() * all_.values(static_cast<Eigen::Index>(i));
      record.outputs[output] = record_of(in_units((*forecasts)[next++], scale), measured);
      surprises[output] = record.outputs[output]->surprise.standardised;
    }
  }
  const auto taken = calibration_.take(month, proceed);
  if (!taken) return tl::unexpected(taken.error());
  record.taken = *taken;
  record.alarms = watch_.observe(month, surprises);
  return record;
}

}  // namespace recald::drift
