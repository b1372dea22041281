/// What outlives the process: readings, counters, months, results, jobs, events.
///
/// A port. Whatever a call has returned without an error survives a kill and a power cut; whatever
/// it refused has left no trace. Failures are io_failed (full disk, I/O error: try again later) or
/// malformed (damage).
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <set>
#include <span>
#include <stop_token>
#include <string>
#include <string_view>
#include <vector>

#include "adapters/ports/job_result.hpp"
#include "core/metering/interval_book.hpp"
#include "core/metering/monthly_figure.hpp"
#include "core/metering/power_book.hpp"
#include "core/metering/reading.hpp"
#include "core/result.hpp"

namespace recald {

/// A reading as it is stored, with how often it was put right.
struct StoredInterval {
  metering::Reading reading;
  int revision = 0;
};

/// One register of one meter between two samples: all that must survive a restart.
struct RegisterState {
  std::string field;  ///< Name in the register map.
  metering::CounterState counter;
  metering::IntervalBook book;
  metering::PowerBook power;           ///< In the place of both, of a meter that counts nothing.
  metering::CounterSettings settings;  ///< Under which the state was reached.
  std::string identity;                ///< Serial number as read; empty: the map has none.
};

/// A register as it was read, before anything was made of it.
struct RawSample {
  std::uint32_t meter;
  std::string field;
  metering::Instant time;
  double value;  ///< In the field's unit; NaN: the register's "no value".
};

enum class Severity : std::uint8_t { info, warning, error };

/// Something that happened and that people may ask about.
struct StoreEvent {
  metering::Instant time;
  Severity severity = Severity::info;
  std::string kind;     ///< "counter_reset"
  std::string subject;  ///< Id of a meter, bus or model; empty: the site.
  std::string text;     ///< A sentence.
  /// What happens again and again is one event: one of the same kind and subject within a day is
  /// counted, and its sentence takes the place of the last.
  bool is_counted = false;
  int count = 1;                          ///< Given by the store, as the next.
  std::optional<metering::Instant> last;  ///< When it happened last, of several times.
};

enum class JobKind : std::uint8_t { calibration, diagnosis };
enum class JobState : std::uint8_t { waiting, running, done, failed, cancelled };

/// Long work that was asked for and, once done, its result.
struct StoredJob {
  std::int64_t number = 0;  ///< Given by the store; 1, 2, 3 …
  JobKind kind = JobKind::calibration;
  JobState state = JobState::waiting;
  std::string asked_by;  ///< "month", "weather", "schedule", "api", "signal", "drift"
  metering::Instant asked;
  std::optional<metering::Instant> started;
  std::optional<metering::Instant> ended;
  bool accepted = false;  ///< Passed its gates: the latest such result is the one in use.
  std::string message;    ///< Why it failed, or was not accepted; else empty.
  std::string folder;     ///< With its files, beside the store; empty: none.
  int tries = 0;          ///< How often it was begun.
  JobResult result;       ///< Empty until done.
};

/// What was expected of one month of one output before its figure was looked at, and how it did.
struct StoredForecast {
  std::string output;  ///< "steam_daily_kWh"
  metering::Month month;
  int revision = 0;  ///< Given by the store: of this output and month.
  std::string model_version;
  std::string data_revision;  ///< Of the readings when it was made.
  metering::Instant made;
  double mean = 0.0, sd = 0.0;  ///< In the output's unit, as the next four.
  double q05 = 0.0, q50 = 0.0, q95 = 0.0;
  double measured = 0.0;
  double pit = 0.0;
  double standardised = 0.0;
  double log_score = 0.0;
  double crps = 0.0;
};

/// "calibration", "running" and so on, as files and people read them.
[[nodiscard]] std::string_view name_of(JobKind kind);
[[nodiscard]] std::string_view name_of(JobState state);

/// A closed month as it is stored.
struct StoredMonth {
  metering::MonthlyFigure figure;
  metering::Instant closed_at;
  std::string time_zone_release;  ///< With which it was closed.
};

/// Readings that a person put in.
struct StoreEdit {
  metering::Instant time;
  std::string author;
  std::string reason;  ///< Not empty.
  std::string file;    ///< Its name, without the folder.
  std::string sha256;  ///< Of the file's bytes.
};

struct MeterMonth {
  std::uint32_t meter;
  metering::Month month;

  bool operator==(const MeterMonth&) const = default;
};

/// What one commit contains: intervals together with the states that explain them.
struct StoreBatch {
  struct Interval {
    metering::Reading reading;
    bool supersedes = false;
  };
  struct Register {
    std::uint32_t meter;
    RegisterState state;
  };
  std::vector<Interval> intervals;
  std::vector<Register> registers;
  std::vector<RawSample> samples;
  std::vector<StoreEvent> events;
  std::vector<MeterMonth> reopened;  ///< Closed months that the intervals change.
  std::optional<std::int64_t> edit;  ///< The edit by hand that the intervals belong to.

  [[nodiscard]] bool empty() const {
    return intervals.empty() && registers.empty() && samples.empty() && events.empty() &&
           reopened.empty();
  }
};

/// What a commit did with its intervals.
struct CommitCounts {
  int taken = 0;       ///< First of their interval, or better than what was there.
  int duplicates = 0;  ///< Said what was known.
  int weaker = 0;      ///< Known better already.
  std::vector<metering::Reading> conflicts;  ///< As good, with another value; the first stays.
  std::vector<bool> was_taken;               ///< By interval of the batch.
};

/// What a store says of itself. In a damaged one nothing else is looked for.
struct StoreCheck {
  std::string damage;                 ///< In the words of what keeps it; empty: none.
  std::vector<std::string> problems;  ///< A sentence each.
  std::uint64_t intervals = 0;        ///< Rows, all revisions.
};

/// A consistent copy of a store that goes on being written: made a portion at a time, then looked
/// through, then kept. Given up before, it leaves nothing.
class StoreBackup {
 public:
  virtual ~StoreBackup() = default;

  /// Copies some pages more, of 4 KiB each. @return whether the copy is whole.
  virtual Result<bool> step(int pages) = 0;

  /// Reads all of a whole copy, which takes long and may be done in another thread.
  /// @param stop  Ends it from outside.
  /// @return its damage, which mostly is the store's too; empty: none. Or why it cannot be read;
  ///         cancelled when it was stopped.
  virtual Result<std::string> check(const std::stop_token& stop) = 0;

  /// Puts a whole copy into its place. @return or io_failed.
  virtual Result<void> keep() = 0;
};

class Store {
 public:
  virtual ~Store() = default;

  /// The number that stands for a meter in this store; a new one for an id never seen.
  /// @return or unsupported when the meter is known with another interval.
  virtual Result<std::uint32_t> meter_number(const std::string& id,
                                             std::chrono::seconds interval) = 0;

  /// The number of a meter that is stored already; works on a store opened to read.
  virtual Result<std::optional<std::uint32_t>> find_meter(const std::string& id) = 0;

  /// All of it or nothing. Intervals are placed by `metering::place`; meters are store numbers.
  virtual Result<CommitCounts> commit(const StoreBatch& batch) = 0;

  /// @param make_room  Asked when a commit is refused, as by a full disk; true: room was made, and
  ///                   the commit is tried once more.
  virtual void on_refusal(std::function<bool()> make_room) = 0;

  /// All that `work` writes is one commit; what fails leaves no trace of it.
  /// @return what `work` returned, or why it could not be committed.
  virtual Result<void> as_one(const std::function<Result<void>()>& work) = 0;

  /// The latest revision of each interval that starts in the span, in order of time.
  virtual Result<void> for_each_interval(
      std::uint32_t meter, const metering::TimeSpan& span,
      const std::function<void(const StoredInterval&)>& visit) = 0;

  /// First start and last start, if there is any.
  virtual Result<std::optional<metering::TimeSpan>> interval_extent(std::uint32_t meter) = 0;

  /// Whether any meter was read in the span: a good interval starts in it.
  virtual Result<bool> was_read_in(const metering::TimeSpan& span) = 0;

  virtual Result<std::vector<RegisterState>> registers(std::uint32_t meter) = 0;

  /// Samples of one field that have been kept, in order of time.
  virtual Result<void> for_each_sample(
      std::uint32_t meter, const std::string& field,
      const std::function<void(const metering::RegisterSample&)>& visit) = 0;

  /// Deletes samples from before `keep_from`, a bounded number at a time.
  /// @return how many; fewer than `rows_max` when none are left.
  virtual Result<int> delete_samples(metering::Instant keep_from, int rows_max) = 0;

  /// An edit, which intervals then name. @return its number, or invalid_value without a reason.
  virtual Result<std::int64_t> add_edit(const StoreEdit& edit) = 0;

  /// Forgets an edit that no interval names.
  virtual Result<void> remove_edit(std::int64_t number) = 0;

  /// The UTC days, as their midnights, with intervals that an edit put there, in any revision.
  virtual Result<std::set<metering::Instant>> edited_days(std::uint32_t meter) = 0;

  /// Months that were closed and have changed since, until they are put again.
  virtual Result<std::vector<MeterMonth>> reopened() = 0;

  /// A month's figure, as revision 0 or one more than the last. @return the revision.
  virtual Result<int> put_month(std::uint32_t meter, const metering::MonthlyFigure& figure,
                                const std::string& time_zone_release, metering::Instant now) = 0;

  /// The latest revision of each month, ascending.
  virtual Result<std::vector<StoredMonth>> months(std::uint32_t meter) = 0;

  /// The rules that the meter's months were closed by; empty: it has none yet.
  virtual Result<std::string> closing_rules(std::uint32_t meter) = 0;

  /// The meter's months close by these rules from now on. Where they were others, the closed months
  /// are reopened. @return how many were.
  virtual Result<int> put_closing_rules(std::uint32_t meter, const std::string& rules) = 0;

  /// Deletes events that happened last before `keep_from`, a bounded number at a time.
  /// @return how many; fewer than `rows_max` when none are left.
  virtual Result<int> delete_events(metering::Instant keep_from, int rows_max) = 0;

  /// The newest events first.
  virtual Result<std::vector<StoreEvent>> events(int limit) = 0;

  /// A new job, whatever number it has. @return its number.
  virtual Result<std::int64_t> add_job(const StoredJob& job) = 0;

  /// What has become of a job. @return not_found for a number that was never given.
  virtual Result<void> put_job(const StoredJob& job) = 0;

  virtual Result<std::optional<StoredJob>> job(std::int64_t number) = 0;

  /// The newest first, without their results.
  virtual Result<std::vector<StoredJob>> jobs(JobKind kind, int limit) = 0;

  /// The oldest that has ended and is neither among the newest `kept` that have, nor in use: the
  /// newest that was accepted. Without its result.
  virtual Result<std::optional<StoredJob>> oldest_job_beyond(JobKind kind, int kept) = 0;

  virtual Result<void> delete_job(std::int64_t number) = 0;

  /// The newest that was accepted, with its result.
  virtual Result<std::optional<StoredJob>> last_accepted(JobKind kind) = 0;

  /// Waiting or running, the oldest first.
  virtual Result<std::vector<StoredJob>> unfinished_jobs() = 0;

  /// Those that are new: a forecast of a figure that the same model version made before stays as it
  /// was. Another figure or model version adds a revision. One with a NaN is left out: there would
  /// be nothing to compare, and whoever asks again after a failure would ask for ever.
  virtual Result<void> add_forecasts(std::span<const StoredForecast> forecasts) = 0;

  /// By output, month and revision.
  virtual Result<std::vector<StoredForecast>> forecasts() = 0;

  /// Reads all of it: damage; rows that refer to nothing, revisions with gaps, intervals off their
  /// meter's grid, no more than 20 sentences of a kind.
  virtual Result<StoreCheck> check() = 0;

  /// Begins a copy, which takes the place of `file` when it is kept. The store lives until it is
  /// whole.
  virtual Result<std::unique_ptr<StoreBackup>> begin_backup(const std::filesystem::path& file) = 0;
};

}  // namespace recald
