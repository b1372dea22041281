/// The first screen of a page: one sentence, one picture, three numbers.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "adapters/views/frame/html.hpp"
#include "adapters/views/frame/report_data.hpp"
#include "adapters/views/frame/script_json.hpp"

namespace recald::views {

/// One meter's panel of the picture.
struct OverviewMonth {
  metering::Month month;
  std::string number;  ///< As `OutputMonth::number`.
  assessment::MonthRole role;
  double measured;                            ///< NaN: no usable value.
  std::optional<std::array<double, 3>> band;  ///< 5 %, middle and 95 % of the expected values.
};

struct OverviewMeter {
  std::string label;
  std::string unit;
  std::vector<OverviewMonth> months;
};

/// More panels would make the picture unreadable.
inline constexpr std::size_t kOverviewMeters = 8;

/// The sentence and its consequence.
void write_first_words(Html& html, const FirstScreen& first);
void write_key_numbers(Html& html, const FirstScreen& first);

/// The band of a picture.
struct Expected {
  std::string_view what;     ///< "forecast from the outdoor temperature"
  std::string_view reading;  ///< What inside and outside the band mean, as a sentence.
};

void write_overview(Html& html, const std::vector<OverviewMeter>& meters, const Expected& expected);

/// The overview of a calibrated model alone; the band covers the months of the calibration.
[[nodiscard]] std::vector<OverviewMeter> model_overview(const ReportData& data);

[[nodiscard]] nlohmann::json overview_json(const std::vector<OverviewMeter>& meters);

}  // namespace recald::views
