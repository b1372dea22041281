/// What outlives the process: readings, counters, months, results, jobs, events.
///
/// A port. Everything that a call returned without an error survives a kill and a power cut; a
/// refused call leaves no trace. Failures are io_failed (full disk, I/O error: try again later) or
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
#include <variant>
#include <vector>

#include "adapters/ports/job_result.hpp"
#include "core/metering/months/monthly_figure.hpp"
#include "core/metering/reading.hpp"
#include "core/metering/registers/interval_book.hpp"
#include "core/metering/registers/power_book.hpp"
#include "core/result.hpp"

namespace recald {

/// A reading as stored, with the number of corrections.
struct StoredInterval {
  metering::Reading reading;
  int revision = 0;
};

/// One register of one meter between two samples: everything that must survive a restart.
struct RegisterState {
  std::string field;  ///< Name in the register map.
  metering::CounterState counter;
  metering::IntervalBook book;
  metering::PowerBook power;           ///< Replaces both for a meter without a counter.
  metering::CounterSettings settings;  ///< The settings under which the state was reached.
  std::string identity;                ///< Serial number as read; empty: the map has none.
};

/// A register as read, before any processing.
struct RawSample {
  std::uint32_t meter;
  std::string field;
  metering::Instant time;
  double value;  ///< In the field's unit; NaN: the register's "no value".
};

enum class Severity : std::uint8_t { info, warning, error };

/// An event that people may ask about.
struct StoreEvent {
  metering::Instant time;
  Severity severity = Severity::info;
  std::string kind;     ///< "counter_reset"
  std::string subject;  ///< Id of a meter, bus or model; empty: the site.
  std::string text;     ///< A sentence.
  /// Repeated events are stored as one: an event of the same kind and subject within a day is
  /// counted, and its sentence replaces the last.
  bool is_counted = false;
  int count = 1;                          ///< Set by the store, as the next two.
  std::optional<metering::Instant> last;  ///< Time of the latest, if it happened several times.
  std::int64_t number = 0;  ///< 1, 2, 3 …; one event that is counted keeps its first.
};

enum class JobKind : std::uint8_t { calibration, diagnosis };
enum class JobState : std::uint8_t { waiting, running, done, failed, cancelled };

/// A long task and, once it is done, its result.
struct StoredJob {
  std::int64_t number = 0;  ///< Set by the store; 1, 2, 3 …
  JobKind kind = JobKind::calibration;
  JobState state = JobState::waiting;
  std::string asked_by;  ///< "month", "weather", "schedule", "api", "signal", "drift"
  metering::Instant asked;
  std::optional<metering::Instant> started;
  std::optional<metering::Instant> ended;
  bool accepted = false;  ///< Passed its checks; the latest such result is in use.
  std::string message;    ///< Why it failed or was not accepted; else empty.
  std::string folder;     ///< Holds its files, beside the store; empty: none.
  int tries = 0;          ///< Number of times it was started.
  JobResult result;       ///< Empty until done.
};

/// A forecast of one month of one output, made before its figure was seen, and how it compared.
struct StoredForecast {
  std::string output;  ///< "steam_daily_kWh"
  metering::Month month;
  int revision = 0;  ///< Set by the store, per output and month.
  std::string model_version;
  std::string data_revision;  ///< Of the readings when the forecast was made.
  metering::Instant made;
  double mean = 0.0, sd = 0.0;  ///< In the output's unit, as the next four.
  double q05 = 0.0, q50 = 0.0, q95 = 0.0;
  double measured = 0.0;
  double pit = 0.0;
  double standardised = 0.0;
  double log_score = 0.0;
  double crps = 0.0;
};

/// "calibration", "running" and so on, as in files and for people.
[[nodiscard]] std::string_view name_of(JobKind kind);
[[nodiscard]] std::string_view name_of(JobState state);

/// A closed month as stored.
struct StoredMonth {
  metering::MonthlyFigure figure;
  metering::Instant closed_at;
  std::string time_zone_release;  ///< Used when it was closed.
};

/// One change that destinations outside are told: an interval or a month as it was stored then.
struct OutboxEntry {
  std::int64_t number = 0;  ///< 1, 2, 3 …; none is given twice.
  std::string meter;        ///< Its id.
  std::chrono::seconds interval{};
  /// Nothing for what damage took.
  std::variant<std::monostate, StoredInterval, StoredMonth> stored;
};

/// The cursor over the events (Store::cursor) of a destination that has them beside the outbox.
[[nodiscard]] inline std::string events_cursor(const std::string& destination) {
  return "events of " + destination;
}

/// How far a destination has been told.
struct OutboxPosition {
  std::int64_t sent;  ///< Number of the last entry that it has had.
  std::int64_t last;  ///< Number of the last entry of all.
};

/// Readings that a person entered.
struct StoreEdit {
  metering::Instant time;
  std::string author;
  std::string reason;  ///< Not empty.
  std::string file;    ///< File name without the folder.
  std::string sha256;  ///< Of the file's bytes.
};

struct MeterMonth {
  std::uint32_t meter;
  metering::Month month;

  bool operator==(const MeterMonth&) const = default;
};

/// The content of one commit: intervals together with the states that explain them.
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
  int taken = 0;                             ///< New intervals, or better than the stored ones.
  int duplicates = 0;                        ///< Equal to the stored ones.
  int weaker = 0;                            ///< Worse than the stored ones.
  std::vector<metering::Reading> conflicts;  ///< Equally good, but another value; the first stays.
  std::vector<bool> was_taken;               ///< One per interval of the batch.
};

/// The result of checking a store. If it is damaged, nothing else is checked.
struct StoreCheck {
  std::string damage;                 ///< In the words of the storage library; empty: none.
  std::vector<std::string> problems;  ///< One sentence each.
  std::uint64_t intervals = 0;        ///< Rows, including all revisions.
};

/// What a store has, whatever version of recald wrote it.
struct StoreSummary {
  int schema_version = 0;
  std::vector<std::string> meters;          ///< Ids, in order of their numbers.
  std::optional<metering::Instant> newest;  ///< Start of the newest interval; absent: none.
};

/// A backup that is about to take the place of a store: copied beside it and checked. Abandoned
/// before it is kept, it leaves nothing.
class StoreRestoration {
 public:
  virtual ~StoreRestoration() = default;

  /// Of the backup.
  [[nodiscard]] virtual const StoreSummary& summary() const = 0;

  /// Puts the copy in place, with an event "store_restored" that says so. Call it once.
  /// @return the name under which the replaced store is kept, empty when there was none; or
  ///         io_failed: then the old store is in place, or the next to open it puts the copy there.
  virtual Result<std::filesystem::path> keep(metering::Instant now) = 0;
};

/// A consistent copy of a store that is still being written: copied in portions, checked, then
/// kept. Abandoned before that, it leaves nothing.
class StoreBackup {
 public:
  virtual ~StoreBackup() = default;

  /// Copies some more pages of 4 KiB each. @return whether the copy is complete.
  virtual Result<bool> step(int pages) = 0;

  /// Reads all of a complete copy, which takes long and may be done in another thread.
  /// @param stop  Cancels the check.
  /// @return its damage, which is usually the store's too; empty: none. Or why it cannot be read;
  ///         cancelled if it was stopped.
  virtual Result<std::string> check(const std::stop_token& stop) = 0;

  /// Moves a complete copy into place. @return or io_failed.
  virtual Result<void> keep() = 0;
};

class Store {
 public:
  virtual ~Store() = default;

  /// The number of a meter in this store; an unknown id gets a new one.
  /// @return the number, or unsupported when the meter is stored with another interval.
  virtual Result<std::uint32_t> meter_number(const std::string& id,
                                             std::chrono::seconds interval) = 0;

  /// The number of a meter that is already stored; also works on a store opened to read.
  virtual Result<std::optional<std::uint32_t>> find_meter(const std::string& id) = 0;

  /// Commits all or nothing. Intervals are placed by `metering::place`; meters are store numbers.
  virtual Result<CommitCounts> commit(const StoreBatch& batch) = 0;

  /// @param make_room  Called when a commit is refused, for example by a full disk. If it returns
  ///                   true, room was made and the commit is tried once more.
  virtual void on_refusal(std::function<bool()> make_room) = 0;

  /// Commits everything that `work` writes at once; a failure leaves no trace.
  /// @return what `work` returned, or why it could not be committed.
  virtual Result<void> as_one(const std::function<Result<void>()>& work) = 0;

  /// The latest revision of each interval that starts in the span, in order of time.
  virtual Result<void> for_each_interval(
      std::uint32_t meter, const metering::TimeSpan& span,
      const std::function<void(const StoredInterval&)>& visit) = 0;

  /// First start and last start, if there is any.
  virtual Result<std::optional<metering::TimeSpan>> interval_extent(std::uint32_t meter) = 0;

  /// Whether any meter has a good interval that starts in the span.
  virtual Result<bool> was_read_in(const metering::TimeSpan& span) = 0;

  virtual Result<std::vector<RegisterState>> registers(std::uint32_t meter) = 0;

  /// The kept samples of one field, in order of time.
  virtual Result<void> for_each_sample(
      std::uint32_t meter, const std::string& field,
      const std::function<void(const metering::RegisterSample&)>& visit) = 0;

  /// Deletes samples from before `keep_from`, at most `rows_max` at a time.
  /// @return how many; fewer than `rows_max` when none are left.
  virtual Result<int> delete_samples(metering::Instant keep_from, int rows_max) = 0;

  /// Adds an edit, to which intervals then refer. @return its number, or invalid_value
  /// without a reason.
  virtual Result<std::int64_t> add_edit(const StoreEdit& edit) = 0;

  /// Deletes an edit that no interval refers to.
  virtual Result<void> remove_edit(std::int64_t number) = 0;

  /// UTC days, given as their midnights, with intervals from an edit, in any revision.
  virtual Result<std::set<metering::Instant>> edited_days(std::uint32_t meter) = 0;

  /// Closed months that have changed since, until they are stored again.
  virtual Result<std::vector<MeterMonth>> reopened() = 0;

  /// Stores a month's figure, as revision 0 or the next. @return the revision.
  virtual Result<int> put_month(std::uint32_t meter, const metering::MonthlyFigure& figure,
                                const std::string& time_zone_release, metering::Instant now) = 0;

  /// The latest revision of each month, ascending.
  virtual Result<std::vector<StoredMonth>> months(std::uint32_t meter) = 0;

  /// The rules by which the meter's months were closed; empty: none yet.
  virtual Result<std::string> closing_rules(std::uint32_t meter) = 0;

  /// Sets the rules by which the meter's months are closed from now on. If they differ from the
  /// previous ones, closed months are reopened. @return how many.
  virtual Result<int> put_closing_rules(std::uint32_t meter, const std::string& rules) = 0;

  /// Deletes events that last happened before `keep_from`, at most `rows_max` at a time.
  /// @return how many; fewer than `rows_max` when none are left.
  virtual Result<int> delete_events(metering::Instant keep_from, int rows_max) = 0;

  /// Newest first.
  virtual Result<std::vector<StoreEvent>> events(int limit) = 0;

  /// Those with a greater number, in order of their numbers.
  virtual Result<std::vector<StoreEvent>> events_after(std::int64_t number, int limit) = 0;

  /// How far a destination outside has been told; nothing for an unknown one.
  virtual Result<std::optional<std::int64_t>> cursor(const std::string& destination) = 0;

  virtual Result<void> put_cursor(const std::string& destination, std::int64_t position) = 0;

  /// Sets which destinations are told of each interval and month that is stored from now on; until
  /// then, of none. Those that were set before keep their positions, others lose theirs. What
  /// everyone has been told is forgotten.
  virtual Result<void> keep_outbox_for(const std::vector<std::string>& destinations) = 0;

  /// Entries with a greater number, in order of their numbers.
  virtual Result<std::vector<OutboxEntry>> outbox_after(std::int64_t number, int limit) = 0;

  virtual Result<OutboxPosition> outbox_position(const std::string& destination) = 0;

  /// The destination has had all entries up to this number.
  virtual Result<void> put_outbox_position(const std::string& destination, std::int64_t number) = 0;

  /// Adds a job and ignores its number. @return the new number.
  virtual Result<std::int64_t> add_job(const StoredJob& job) = 0;

  /// Updates a job. @return not_found for an unknown number.
  virtual Result<void> put_job(const StoredJob& job) = 0;

  virtual Result<std::optional<StoredJob>> job(std::int64_t number) = 0;

  /// Newest first, without their results.
  virtual Result<std::vector<StoredJob>> jobs(JobKind kind, int limit) = 0;

  /// The oldest finished job that is neither among the newest `kept` finished ones nor in use (the
  /// newest accepted one). Without its result.
  virtual Result<std::optional<StoredJob>> oldest_job_beyond(JobKind kind, int kept) = 0;

  virtual Result<void> delete_job(std::int64_t number) = 0;

  /// The newest accepted job, with its result.
  virtual Result<std::optional<StoredJob>> last_accepted(JobKind kind) = 0;

  /// Waiting or running jobs, oldest first.
  virtual Result<std::vector<StoredJob>> unfinished_jobs() = 0;

  /// Adds only new forecasts. If the same model version already forecast the same figure, the old
  /// one stays; another figure or model version adds a revision. A forecast with a NaN is skipped:
  /// it could not be compared, and a caller that retries after failures would retry forever.
  virtual Result<void> add_forecasts(std::span<const StoredForecast> forecasts) = 0;

  /// Ordered by output, month and revision.
  virtual Result<std::vector<StoredForecast>> forecasts() = 0;

  /// Reads the whole store and reports damage, rows that refer to nothing, gaps in revisions, and
  /// intervals off their meter's grid; at most 20 sentences of a kind.
  virtual Result<StoreCheck> check() = 0;

  /// Begins a copy, which replaces `file` when it is kept. The store must outlive the copying.
  virtual Result<std::unique_ptr<StoreBackup>> begin_backup(const std::filesystem::path& file) = 0;
};

}  // namespace recald
