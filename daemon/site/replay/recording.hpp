/// Recorded readings through the same pipeline as live ones, on a virtual clock.
#pragma once

#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "adapters/csv/readings_csv.hpp"
#include "adapters/ports/clock.hpp"
#include "core/metering/data_quality.hpp"
#include "core/metering/level_change.hpp"
#include "core/metering/month_closer.hpp"
#include "core/profile/electricity_profile.hpp"
#include "core/result.hpp"
#include "daemon/site/config/site_config.hpp"

namespace recald::daemon {

/// All that is kept of one meter: figures for ever, hourly means for profiles and pictures, what
/// was wrong. The readings themselves pass through.
struct MeterRecord {
  metering::Meter meter;                    ///< With the interval that the file showed.
  std::optional<csv::MeterInFile> in_file;  ///< None: the file has no row of it.
  csv::MeterReport rows{};
  std::vector<metering::MonthlyFigure> figures;  ///< Ascending; the latest revision of each month.
  std::map<metering::Month, std::vector<profile::HourlyLoad>> hours;
  metering::MeterCounts counts;
  std::vector<metering::LevelChange> level_changes;
  std::vector<metering::DataFinding> findings;
  std::string doubt;  ///< In a sentence, also among the findings: whether it is a register.
};

struct FileIssues {
  std::filesystem::path file;
  csv::LineIssues issues;
  csv::OtherMeters others;  ///< Whose lines were left out.
};

struct Recording {
  std::vector<MeterRecord> meters;  ///< One for each of the site's meters.
  std::vector<FileIssues> files;
  std::uint64_t readings = 0;
  std::vector<std::string> notes;  ///< In words: what is not settled about the months.
};

/// Whether any meter of the site says that this month is not like the same months before. A model
/// couples the meters: when one of them shows another building, all of them are its meters.
[[nodiscard]] bool is_site_different(const Recording& recording, metering::Month month);

struct ReplayOptions {
  std::optional<metering::Day> from;  ///< Local days, inclusive; readings outside are left out.
  std::optional<metering::Day> to;
};

/// Told when a month closes, with the virtual time at which it did.
using OnMonthClosed = std::function<void(const metering::Meter&, const metering::MonthlyFigure&,
                                         metering::Instant now)>;

using ReadingSink = std::function<void(const metering::Reading&)>;

/// Where the months and the readings of live meters are found again.
class LiveReadings {
 public:
  virtual ~LiveReadings() = default;

  /// The closed months of one meter, ascending, each in its latest revision.
  virtual Result<std::vector<metering::MonthlyFigure>> months(const MeterConfig& meter) = 0;

  /// How many of them wait to be closed anew: late readings or another rule have changed them.
  virtual Result<int> waiting_months(const MeterConfig& meter) = 0;

  /// The readings of one meter that start in the span, in order of time. @return how many.
  virtual Result<std::uint64_t> for_each(const MeterConfig& meter, const metering::TimeSpan& span,
                                         const ReadingSink& sink) = 0;

  /// Start of the first of them; nothing where there is none.
  virtual Result<std::optional<metering::Instant>> first_start(const MeterConfig& meter) = 0;
};

/// Whether some meter of the site is read live.
[[nodiscard]] bool has_stored_meters(const SiteConfig& site);

/// Reads every file of the site's meters once, in order of time as the files have it, then what
/// live meters left behind, and closes months as time passes.
///
/// @param live  Where live meters' readings are; null: live meters are left without a record.
/// @return not_found / io_failed / malformed with the file's name; not_enough_data when a file has
///         no row of a meter that the site declares, or of live meters none was ever read.
[[nodiscard]] Result<Recording> replay_meters(const SiteConfig& site,
                                              const metering::LocalCalendar& calendar,
                                              const ReplayOptions& options, VirtualClock& clock,
                                              const OnMonthClosed& on_month_closed,
                                              LiveReadings* live = nullptr);

/// Gives live meters their figures: the months that the daemon has closed, not closed once more.
/// Those of their sums are made of the readings.
/// @return or the store's failure.
[[nodiscard]] Result<void> take_closed_months(const SiteConfig& site,
                                              const metering::LocalCalendar& calendar,
                                              LiveReadings& live, Recording& recording);

/// Gives live meters their hours and findings in these months: what profiles, pictures and
/// diagnoses need of the readings. Figures stay as they are.
/// @return or the store's failure.
[[nodiscard]] Result<void> take_hours(const SiteConfig& site,
                                      const metering::LocalCalendar& calendar,
                                      const metering::MonthRange& months, LiveReadings& live,
                                      Recording& recording);

}  // namespace recald::daemon
