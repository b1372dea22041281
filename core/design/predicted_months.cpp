#include "core/design/predicted_months.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "core/regression/weather_response.hpp"
#include "core/weather/daily_inputs.hpp"

namespace recald::design {
namespace {

using Eigen::Index;
using metering::Day;
using metering::Month;
using weather::DailyInputs;

// Of a month's days; the others stand for those that are lacking.
constexpr double kKnownShare = 0.9;
// Beyond the range of the design's months, as a share of it. Of four quantities over a year one is
// always a hair beyond.
constexpr double kBeyondShare = 0.05;

/// Days whose weather is known, as the regression takes them.
struct KnownDays {
  regression::ResponseDays response;
  std::vector<Index> rows;                ///< Of the inputs.
  std::vector<Month> months;              ///< By their number in `response.months`.
  std::vector<Eigen::RowVectorXd> means;  ///< (months) of `weather::kDayMeans`.
};

Month month_of(Day day) { return day.year() / day.month(); }

double year_phase(Day day) {
  const auto since = std::chrono::sys_days{day} - std::chrono::sys_days{day.year() / 1 / 1};
  return 2.0 * std::numbers::pi * static_cast<double>(since.count()) / 365.25;
}

/// @pre the days of a month lie together
KnownDays known_days(const DailyInputs& inputs, const model::Holidays& holidays) {
  KnownDays known;
  for (Index i = 0; i < inputs.terms.rows(); ++i) {
    if (!inputs.terms.row(i).allFinite()) continue;
    const Day day = inputs.days[static_cast<std::size_t>(i)];
    if (known.months.empty() || known.months.back() != month_of(day)) {
      known.months.push_back(month_of(day));
    }
    known.rows.push_back(i);
    known.response.months.push_back(static_cast<int>(known.months.size()) - 1);
    known.response.kinds.push_back(static_cast<int>(model::day_type(day, holidays)));
  }
  known.response.terms = inputs.terms(known.rows, Eigen::all);
  known.response.season.resize(static_cast<Index>(known.rows.size()));
  known.means.assign(known.months.size(), Eigen::RowVectorXd::Zero(inputs.means.cols()));
  std::vector<double> counts(known.months.size(), 0.0);
  for (std::size_t i = 0; i < known.rows.size(); ++i) {
    const auto month = static_cast<std::size_t>(known.response.months[i]);
    known.response.season[static_cast<Index>(i)] =
        year_phase(inputs.days[static_cast<std::size_t>(known.rows[i])]);
    known.means[month] += inputs.means.row(known.rows[i]);
    counts[month] += 1.0;
  }
  for (std::size_t m = 0; m < counts.size(); ++m) known.means[m] /= counts[m];
  return known;
}

/// The wanted months that were not simulated, ascending, without those of little weather.
std::vector<Month> months_to_predict(std::vector<Month> wanted, const std::vector<Month>& simulated,
                                     const PredictionWeather& weather,
                                     std::vector<LittleWeather>& left_out) {
  std::ranges::sort(wanted);
  const auto twice = std::ranges::unique(wanted);
  wanted.erase(twice.begin(), twice.end());
  std::vector<Month> months;
  for (const Month month : wanted) {
    if (std::ranges::find(simulated, month) != simulated.end()) continue;
    const DailyInputs inputs =
        daily_inputs(weather.series, weather.calendar, weather::days_of({month}));
    const auto count = static_cast<int>(inputs.terms.rows());
    const auto known = static_cast<int>(inputs.means.col(0).array().isFinite().count());
    if (known >= kKnownShare * count) {
      months.push_back(month);
    } else {
      left_out.push_back({month, known, count});
    }
  }
  return months;
}

std::vector<UnseenWeather> unseen_weather(const KnownDays& simulated, const KnownDays& predicted) {
  std::vector<UnseenWeather> all;
  for (std::size_t q = 0; q < weather::kDayMeans.size(); ++q) {
    const auto column = static_cast<Index>(q);
    const auto value = [&](const Eigen::RowVectorXd& means) { return means[column]; };
    const auto [least, most] = std::ranges::minmax(simulated.means, {}, value);
    UnseenWeather unseen{.quantity = q, .low = value(least), .high = value(most), .beyond = {}};
    const double slack = kBeyondShare * (unseen.high - unseen.low);
    for (std::size_t m = 0; m < predicted.months.size(); ++m) {
      const double mean = value(predicted.means[m]);
      if (mean >= unseen.low - slack && mean <= unseen.high + slack) continue;
      unseen.beyond.push_back({predicted.months[m], mean});
    }
    if (!unseen.beyond.empty()) all.push_back(std::move(unseen));
  }
  return all;
}

/// The values of known days. (runs x outputs * known)
Eigen::MatrixXd values_of(const SimulatedDays& days, const std::vector<Index>& rows,
                          Index outputs) {
  const auto all = static_cast<Index>(days.days.size());
  const auto known = static_cast<Index>(rows.size());
  Eigen::MatrixXd values(days.values.rows(), outputs * known);
  for (Index k = 0; k < outputs; ++k) {
    values.middleCols(k * known, known) = days.values.middleCols(k * all, all)(Eigen::all, rows);
  }
  return values;
}

/// Errors of left-out months of the same time of year, a month before and after included.
/// (outputs x added)
Eigen::MatrixXd seasonal_errors(const regression::WeatherResponse& response,
                                const std::vector<Month>& simulated,
                                const std::vector<Month>& added) {
  const auto apart = [](Month a, Month b) {
    const int months = std::abs(static_cast<int>(static_cast<unsigned>(a.month())) -
                                static_cast<int>(static_cast<unsigned>(b.month())));
    return std::min(months, 12 - months);
  };
  Eigen::MatrixXd errors(static_cast<Index>(response.errors.size()),
                         static_cast<Index>(added.size()));
  for (std::size_t k = 0; k < response.errors.size(); ++k) {
    for (std::size_t m = 0; m < added.size(); ++m) {
      double squares = 0.0;
      double count = 0.0;
      for (std::size_t i = 0; i < simulated.size(); ++i) {
        if (apart(simulated[i], added[m]) > 1) continue;
        squares += std::pow(response.errors[k].by_month[static_cast<Index>(i)], 2);
        count += 1.0;
      }
      errors(static_cast<Index>(k), static_cast<Index>(m)) =
          count > 0.0 ? std::sqrt(squares / count) : response.errors[k].sd;
    }
  }
  return errors;
}

}  // namespace

Result<PredictedMonths> predict_other_months(const SimulatedDays& days,
                                             const std::vector<Month>& simulated,
                                             const PredictionWeather& weather,
                                             std::vector<Month> wanted) {
  PredictedMonths predicted;
  predicted.months = months_to_predict(std::move(wanted), simulated, weather, predicted.left_out);
  const auto outputs = static_cast<Index>(days.is_peak.size());
  predicted.error_sd = Eigen::VectorXd::Zero(outputs);
  predicted.month_error_sd.resize(outputs, std::ssize(predicted.months));
  if (predicted.months.empty()) return predicted;
  const KnownDays seen =
      known_days(daily_inputs(weather.series, weather.calendar, days.days), weather.holidays);
  const KnownDays next =
      known_days(daily_inputs(weather.series, weather.calendar, weather::days_of(predicted.months)),
                 weather.holidays);
  const auto response = TRY(regression::fit_weather_response(
      seen.response, values_of(days, seen.rows, outputs), days.is_peak));
  for (Index k = 0; k < outputs; ++k) {
    predicted.error_sd[k] = response.errors[static_cast<std::size_t>(k)].sd;
  }
  predicted.month_error_sd = seasonal_errors(response, seen.months, predicted.months);
  predicted.unseen = unseen_weather(seen, next);
  predicted.figures = predict_months(response, next.response);
  return predicted;
}

}  // namespace recald::design
