/// What a meter's readings say of the file that they came from: hours that were added up where the
/// clock changed, units that changed on a day.
#pragma once

#include <map>
#include <optional>
#include <string_view>
#include <vector>

#include "core/metering/months/data_quality.hpp"
#include "core/metering/months/month_slots.hpp"

namespace recald::metering {

/// Takes closed months in any order; a month again replaces itself.
class SeriesDoubts {
 public:
  void take(const MonthSlots& month);

  [[nodiscard]] std::vector<DataFinding> describe(std::string_view meter) const;

 private:
  struct SummedHour {
    TimeSpan span;
    double ratio;  ///< To the hours beside it.
  };
  struct HigherEstimate {
    Instant at;
    double estimate_kW;
    double measured_kW;  ///< The highest of the month.
  };
  struct OneMonth {
    std::vector<double> days_kW;  ///< Means; NaN: less than half measured.
    std::vector<SummedHour> summed;
    std::optional<HigherEstimate> higher_estimate;
  };
  [[nodiscard]] static std::optional<SummedHour> summed_hour(const MonthSlots& month, int first,
                                                             int per_hour);
  void find_higher_estimate(const MonthSlots& month);
  [[nodiscard]] std::optional<DataFinding> higher_estimates(std::string_view meter) const;

  std::map<Month, OneMonth> months_;
};

}  // namespace recald::metering
