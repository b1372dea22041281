/// What a client sees first: one sentence, one picture, three numbers.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "adapters/report/html.hpp"
#include "adapters/report/report_data.hpp"
#include "adapters/report/script_json.hpp"

namespace recald::report {

/// One meter's panel of the picture.
struct OverviewMonth {
  metering::Month month;
  std::string number;  ///< As `OutputMonth::number`.
  assessment::MonthRole role;
  double measured;                            ///< NaN: none that may be used.
  std::optional<std::array<double, 3>> band;  ///< 5 %, middle and 95 % of what was expected.
};

struct OverviewMeter {
  std::string label;
  std::string unit;
  std::vector<OverviewMonth> months;
};

/// Panels beyond these make no picture that anybody takes in.
inline constexpr std::size_t kOverviewMeters = 8;

/// The sentence and what follows from it.
void write_first_words(Html& html, const FirstScreen& first);
void write_key_numbers(Html& html, const FirstScreen& first);

/// The band of a picture.
struct Expected {
  std::string_view what;     ///< "forecast from the outdoor temperature"
  std::string_view reading;  ///< What inside and outside mean, as a sentence.
};

void write_overview(Html& html, const std::vector<OverviewMeter>& meters, const Expected& expected);

/// The calibrated model alone as the band: months that belong to the calibration.
[[nodiscard]] std::vector<OverviewMeter> model_overview(const ReportData& data);

[[nodiscard]] nlohmann::json overview_json(const std::vector<OverviewMeter>& meters);

}  // namespace recald::report
