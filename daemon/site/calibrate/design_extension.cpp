#include "daemon/site/calibrate/design_extension.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "core/design/predicted_months.hpp"
#include "core/regression/fit_quality.hpp"
#include "core/weather/daily_inputs.hpp"
#include "core/weather/monthly_inputs.hpp"

namespace recald::daemon {
namespace {

using Eigen::Index;
using metering::Month;

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

/// A sentence for each month left out, and for each quantity in which added months lie outside the
/// design's.
std::vector<std::string> notes_of(const design::PredictedMonths& predicted) {
  std::vector<std::string> notes;
  for (const design::LittleWeather& month : predicted.left_out) {
    notes.push_back(fmt::format(
        "{} cannot be predicted from the design: its weather is known on {} of {} days.",
        metering::to_string(month.month), month.known_days, month.days));
  }
  for (const design::UnseenWeather& unseen : predicted.unseen) {
    std::vector<std::string> outside;
    for (const auto& [month, mean] : unseen.beyond) {
      outside.push_back(fmt::format("{:.1f} in {}", mean, metering::to_string(month)));
    }
    notes.push_back(fmt::format(
        "The design has not seen such weather: {}, {}, was {}; its months had {:.1f} to {:.1f}. "
        "The model's figures are extrapolated there; add runs of these months to the design.",
        weather::kDayMeans[unseen.quantity], weather::kDayMeanUnits[unseen.quantity],
        fmt::join(outside, ", "), unseen.low, unseen.high));
  }
  return notes;
}

std::vector<bool> peaks_of(const std::vector<std::string>& outputs) {
  std::vector<bool> is_peak(outputs.size(), false);
  for (const regression::MeterOutputs& meter : regression::group_by_meter(outputs)) {
    if (meter.peak >= 0) is_peak[static_cast<std::size_t>(meter.peak)] = true;
  }
  return is_peak;
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
  auto predicted =
      design::predict_other_months({days.days, days.values, peaks_of(design.output_names)},
                                   simulated, {weather, calendar, holidays}, std::move(wanted));
  if (!predicted) {
    return failure(predicted.error().code,
                   fmt::format("the design in '{}' cannot be continued: {}", design.folder.string(),
                               predicted.error().message));
  }
  if (!predicted->months.empty()) {
    const auto inputs = TRY(added_inputs(design, simulated, predicted->months, weather, calendar));
    design.inputs = merged(design.inputs, inputs);
    merge_outputs(inputs.months, predicted->figures, design);
  }
  auto notes = notes_of(*predicted);
  return DesignExtension{std::move(design), std::move(predicted->months),
                         std::move(predicted->error_sd), std::move(predicted->month_error_sd),
                         std::move(notes)};
}

}  // namespace recald::daemon
