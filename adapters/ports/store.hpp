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
#include <stop_token>
#include <string>
#include <vector>

#include "adapters/ports/interval_store.hpp"
#include "adapters/ports/job_store.hpp"
#include "adapters/ports/month_store.hpp"
#include "adapters/ports/outbox_store.hpp"
#include "core/result.hpp"

namespace recald {

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

class Store : public IntervalStore,
              public MonthStore,
              public EventStore,
              public OutboxStore,
              public JobStore {
 public:
  /// @param make_room  Called when a commit is refused, for example by a full disk. If it returns
  ///                   true, room was made and the commit is tried once more.
  virtual void on_refusal(std::function<bool()> make_room) = 0;

  /// Commits everything that `work` writes at once; a failure leaves no trace.
  /// @return what `work` returned, or why it could not be committed.
  virtual Result<void> as_one(const std::function<Result<void>()>& work) = 0;

  /// Reads the whole store and reports damage, rows that refer to nothing, gaps in revisions, and
  /// intervals off their meter's grid; at most 20 sentences of a kind.
  virtual Result<StoreCheck> check() = 0;

  /// Begins a copy, which replaces `file` when it is kept. The store must outlive the copying.
  virtual Result<std::unique_ptr<StoreBackup>> begin_backup(const std::filesystem::path& file) = 0;
};

}  // namespace recald
