/// What a meter's readings say of the file that they came from: hours that were added up where the
/// clock changed, units that changed on a day.
#pragma once

#include <map>
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
  struct OneMonth {
    std::vector<double> days_kW;  ///< Means; NaN: less than half measured.
    std::vector<SummedHour> summed;
  };
  std::map<Month, OneMonth> months_;
};

}  // namespace recald::metering
