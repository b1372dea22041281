/// Runs recorded readings through the same pipeline as live ones, on a virtual clock.
#pragma once

#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "adapters/csv/readings_csv.hpp"
#include "adapters/ports/clock.hpp"
#include "core/metering/months/data_quality.hpp"
#include "core/metering/months/level_change.hpp"
#include "core/metering/months/month_closer.hpp"
#include "core/model/electricity_profile.hpp"
#include "core/result.hpp"
#include "daemon/site/config/site_config.hpp"

namespace recald::daemon {

/// Everything kept of one meter: figures permanently, hourly means for profiles and figures, and
/// problems. The readings themselves are not kept.
struct MeterRecord {
  metering::Meter meter;                    ///< With the interval found in the file.
  std::optional<csv::MeterInFile> in_file;  ///< Absent: the file has no row of this meter.
  csv::MeterReport rows{};
  std::vector<metering::MonthlyFigure> figures;  ///< Ascending; the latest revision of each month.
  std::map<metering::Month, std::vector<model::HourlyLoad>> hours;
  metering::MeterCounts counts;
  std::vector<metering::LevelChange> level_changes;
  std::vector<metering::DataFinding> findings;
  std::string doubt;  ///< A sentence, also among the findings: whether it is a register.
  std::vector<std::string> series_doubts;  ///< Likewise: hours added up, units that change.
};

struct FileIssues {
  std::filesystem::path file;
  csv::LineIssues issues;
  csv::OtherMeters others;  ///< Their lines were left out.
};

struct Recording {
  std::vector<MeterRecord> meters;  ///< One per meter of the site.
  std::vector<FileIssues> files;
  std::uint64_t readings = 0;
  std::vector<std::string> notes;  ///< What is uncertain about the months, in words.
};

/// Whether any meter of the site shows that this month differs from the same months before. A
/// model couples the meters, so if one of them shows a changed building, the month counts as
/// different for all.
[[nodiscard]] bool is_site_different(const Recording& recording, metering::Month month);

struct ReplayOptions {
  std::optional<metering::Day> from;  ///< Local days, inclusive; readings outside are ignored.
  std::optional<metering::Day> to;
};

/// Called when a month closes, with the virtual time of closing.
using OnMonthClosed = std::function<void(const metering::Meter&, const metering::MonthlyFigure&,
                                         metering::Instant now)>;

using ReadingSink = std::function<void(const metering::Reading&)>;

/// Access to the stored months and readings of live meters.
class LiveReadings {
 public:
  virtual ~LiveReadings() = default;

  /// The closed months of one meter, ascending, each in its latest revision.
  virtual Result<std::vector<metering::MonthlyFigure>> months(const MeterConfig& meter) = 0;

  /// Number of months to be closed again, because of late readings or a changed rule.
  virtual Result<int> waiting_months(const MeterConfig& meter) = 0;

  /// Passes on the readings of one meter that start in the span, in order of time.
  /// @return how many.
  virtual Result<std::uint64_t> for_each(const MeterConfig& meter, const metering::TimeSpan& span,
                                         const ReadingSink& sink) = 0;

  /// Start of the meter's first reading; nothing if there is none.
  virtual Result<std::optional<metering::Instant>> first_start(const MeterConfig& meter) = 0;
};

/// Whether any meter of the site is read live.
[[nodiscard]] bool has_stored_meters(const SiteConfig& site);

/// Reads every file of the site's meters once, in the order of the file, then the stored readings
/// of live meters, and closes months as time passes.
///
/// @param live  The readings of live meters; null: live meters get no record.
/// @return the recording; or not_found, io_failed or malformed with the file's name;
///         not_enough_data when a file has no row of a declared meter, or no live
///         meter was ever read.
[[nodiscard]] Result<Recording> replay_meters(const SiteConfig& site,
                                              const metering::LocalCalendar& calendar,
                                              const ReplayOptions& options, VirtualClock& clock,
                                              const OnMonthClosed& on_month_closed,
                                              LiveReadings* live = nullptr);

/// Gives live meters their figures: the months as the daemon closed them, without closing them
/// again. The months of their sums are computed from the readings.
/// @return or the store's failure.
[[nodiscard]] Result<void> take_closed_months(const SiteConfig& site,
                                              const metering::LocalCalendar& calendar,
                                              LiveReadings& live, Recording& recording);

/// Gives live meters their hours and findings in these months, which profiles, figures and
/// diagnoses need. The monthly figures do not change.
/// @return or the store's failure.
[[nodiscard]] Result<void> take_hours(const SiteConfig& site,
                                      const metering::LocalCalendar& calendar,
                                      const metering::MonthRange& months, LiveReadings& live,
                                      Recording& recording);

}  // namespace recald::daemon
