#include "daemon/site/calibrate/design_extension.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "core/regression/fit_quality.hpp"
#include "core/regression/weather_response.hpp"
#include "core/weather/daily_inputs.hpp"
#include "core/weather/monthly_inputs.hpp"

namespace recald::daemon {
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

Result<std::vector<Month>> calendar_months(const doe::DesignFolder& design) {
  std::vector<Month> months;
  for (const doe::DesignMonth month : design.months) {
    const auto parsed = metering::parse_month(month.text());
    if (!parsed) {
      return failure(
          ErrorCode::unsupported,
          fmt::format("the months of the design in '{}' are numbers and have no weather; "
                      "name them YYYY-MM to predict others",
                      design.folder.string()));
    }
    months.push_back(*parsed);
  }
  return months;
}

/// The wanted months that the design lacks, ascending, without those of little weather.
std::vector<Month> months_to_add(std::vector<Month> wanted, const std::vector<Month>& simulated,
                                 const weather::WeatherSeries& weather,
                                 const metering::LocalCalendar& calendar,
                                 std::vector<std::string>& notes) {
  std::ranges::sort(wanted);
  const auto twice = std::ranges::unique(wanted);
  wanted.erase(twice.begin(), twice.end());
  std::vector<Month> added;
  for (const Month month : wanted) {
    if (std::ranges::find(simulated, month) != simulated.end()) continue;
    const DailyInputs inputs = daily_inputs(weather, calendar, weather::days_of({month}));
    const auto count = static_cast<double>(inputs.terms.rows());
    const auto known = static_cast<double>(inputs.means.col(0).array().isFinite().count());
    if (known >= kKnownShare * count) {
      added.push_back(month);
    } else {
      notes.push_back(fmt::format(
          "{} cannot be predicted from the design: its weather is known on {:.0f} of {:.0f} days.",
          metering::to_string(month), known, count));
    }
  }
  return added;
}

/// A note for each quantity in which added months lie outside the design's.
void note_beyond(const KnownDays& simulated, const KnownDays& added,
                 std::vector<std::string>& notes) {
  for (std::size_t q = 0; q < weather::kDayMeans.size(); ++q) {
    const auto column = static_cast<Index>(q);
    const auto value = [&](const Eigen::RowVectorXd& means) { return means[column]; };
    const auto [low, high] = std::ranges::minmax(simulated.means, {}, value);
    const double slack = kBeyondShare * (value(high) - value(low));
    std::vector<std::string> outside;
    for (std::size_t m = 0; m < added.months.size(); ++m) {
      const double mean = value(added.means[m]);
      if (mean >= value(low) - slack && mean <= value(high) + slack) continue;
      outside.push_back(fmt::format("{:.1f} in {}", mean, metering::to_string(added.months[m])));
    }
    if (outside.empty()) continue;
    notes.push_back(fmt::format(
        "The design has not seen such weather: {}, {}, was {}; its months had {:.1f} to {:.1f}. "
        "The model's figures are extrapolated there; add runs of these months to the design.",
        weather::kDayMeans[q], weather::kDayMeanUnits[q], fmt::join(outside, ", "), value(low),
        value(high)));
  }
}

/// The values of known days. (runs x outputs * known)
Eigen::MatrixXd values_of(const doe::DesignDays& days, const std::vector<Index>& rows,
                          Index outputs) {
  const auto all = static_cast<Index>(days.days.size());
  const auto known = static_cast<Index>(rows.size());
  Eigen::MatrixXd values(days.values.rows(), outputs * known);
  for (Index k = 0; k < outputs; ++k) {
    values.middleCols(k * known, known) = days.values.middleCols(k * all, all)(Eigen::all, rows);
  }
  return values;
}

std::vector<bool> peaks_of(const std::vector<std::string>& outputs) {
  std::vector<bool> is_peak(outputs.size(), false);
  for (const regression::MeterOutputs& meter : regression::group_by_meter(outputs)) {
    if (meter.peak >= 0) is_peak[static_cast<std::size_t>(meter.peak)] = true;
  }
  return is_peak;
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

/// Rows of the model inputs for the added months.
Result<doe::MonthlyTable> added_inputs(const doe::DesignFolder& design,
                                       const std::vector<Month>& simulated,
                                       const std::vector<Month>& added,
                                       const weather::WeatherSeries& weather,
                                       const metering::LocalCalendar& calendar) {
  doe::MonthlyTable table{{}, design.inputs.names, {}};
  table.values.resize(static_cast<Index>(added.size()), static_cast<Index>(table.names.size()));
  for (const Month month : added) {
    table.months.push_back(*doe::DesignMonth::parse(metering::to_string(month)));
  }
  // Together with the design's months, because inputs that do not vary are left out.
  std::vector<Month> all = added;
  all.insert(all.end(), simulated.begin(), simulated.end());
  const weather::MonthlyInputs given = weather::monthly_inputs(weather, calendar, all);
  for (std::size_t j = 0; j < table.names.size(); ++j) {
    const auto known = std::ranges::find(given.names, table.names[j]);
    for (std::size_t m = 0; m < added.size(); ++m) {
      double& value = table.values(static_cast<Index>(m), static_cast<Index>(j));
      const Index row = design.inputs.row_of(table.months[m]);
      if (row >= 0) {
        value = design.inputs.values(row, static_cast<Index>(j));
      } else if (known != given.names.end()) {
        value = given.values(static_cast<Index>(m), known - given.names.begin());
      } else {
        return failure(ErrorCode::unsupported,
                       fmt::format("'{}': the weather does not give the model input '{}' of {}; "
                                   "add the month to inputs.csv",
                                   design.folder.string(), table.names[j], table.months[m].text()));
      }
    }
  }
  return table;
}

/// Both tables' months in order of time; those of `more` win.
doe::MonthlyTable merged(const doe::MonthlyTable& table, const doe::MonthlyTable& more) {
  doe::MonthlyTable all{{}, table.names, {}};
  std::ranges::set_union(table.months, more.months, std::back_inserter(all.months));
  all.values.resize(static_cast<Index>(all.months.size()), table.values.cols());
  for (std::size_t i = 0; i < all.months.size(); ++i) {
    const Index row = more.row_of(all.months[i]);
    all.values.row(static_cast<Index>(i)) =
        row >= 0 ? more.values.row(row) : table.values.row(table.row_of(all.months[i]));
  }
  return all;
}

/// Puts the added months' figures among the simulated ones.
void merge_outputs(const std::vector<doe::DesignMonth>& added, const Eigen::MatrixXd& figures,
                   doe::DesignFolder& design) {
  std::vector<doe::DesignMonth> months;
  std::ranges::set_union(design.months, added, std::back_inserter(months));
  const auto outputs = static_cast<Index>(design.output_names.size());
  const auto count = static_cast<Index>(months.size());
  const auto before = static_cast<Index>(design.months.size());
  const auto new_count = static_cast<Index>(added.size());
  Eigen::MatrixXd all(design.outputs.rows(), outputs * count);
  for (Index i = 0; i < count; ++i) {
    const auto month = months[static_cast<std::size_t>(i)];
    const auto place = std::ranges::lower_bound(added, month);
    const bool is_added = place != added.end() && *place == month;
    const Index column =
        is_added ? place - added.begin()
                 : std::ranges::lower_bound(design.months, month) - design.months.begin();
    const Eigen::MatrixXd& from = is_added ? figures : design.outputs;
    const Index from_count = is_added ? new_count : before;
    for (Index k = 0; k < outputs; ++k) {
      all.col(k * count + i) = from.col(k * from_count + column);
    }
  }
  design.months = std::move(months);
  design.outputs = std::move(all);
}

}  // namespace

Result<DesignExtension> extend_design(doe::DesignFolder design, const doe::DesignDays& days,
                                      const weather::WeatherSeries& weather,
                                      const metering::LocalCalendar& calendar,
                                      const model::Holidays& holidays, std::vector<Month> wanted) {
  const auto simulated = TRY(calendar_months(design));
  DesignExtension extension;
  extension.added = months_to_add(std::move(wanted), simulated, weather, calendar, extension.notes);
  const auto outputs = static_cast<Index>(design.output_names.size());
  extension.error_sd = Eigen::VectorXd::Zero(outputs);
  extension.month_error_sd.resize(outputs, static_cast<Index>(extension.added.size()));
  if (extension.added.empty()) {
    extension.design = std::move(design);
    return extension;
  }
  const KnownDays seen = known_days(daily_inputs(weather, calendar, days.days), holidays);
  const KnownDays next =
      known_days(daily_inputs(weather, calendar, weather::days_of(extension.added)), holidays);
  const auto response = regression::fit_weather_response(
      seen.response, values_of(days, seen.rows, outputs), peaks_of(design.output_names));
  if (!response) {
    return failure(response.error().code,
                   fmt::format("the design in '{}' cannot be continued: {}", design.folder.string(),
                               response.error().message));
  }
  for (Index k = 0; k < outputs; ++k) {
    extension.error_sd[k] = response->errors[static_cast<std::size_t>(k)].sd;
  }
  extension.month_error_sd = seasonal_errors(*response, seen.months, extension.added);
  note_beyond(seen, next, extension.notes);
  const auto inputs = TRY(added_inputs(design, simulated, extension.added, weather, calendar));
  design.inputs = merged(design.inputs, inputs);
  merge_outputs(inputs.months, predict_months(*response, next.response), design);
  extension.design = std::move(design);
  return extension;
}

}  // namespace recald::daemon
