/// Writes the daemon's regular batches: intervals with the states that explain them.
#pragma once

#include <memory>
#include <unordered_map>

#include "adapters/ports/store.hpp"
#include "adapters/sqlite/tables/database.hpp"

namespace recald::sqlite {

/// Prepares its statements once.
class BatchWriter {
 public:
  /// @param database  Outlives the writer. It may move: the statements do not
  ///                  depend on its address.
  [[nodiscard]] static Result<BatchWriter> prepare(Database& database);

  ~BatchWriter();
  BatchWriter(BatchWriter&&) noexcept;
  BatchWriter& operator=(BatchWriter&&) noexcept;

  /// @pre runs within a transaction: half a batch is worse than none.
  [[nodiscard]] Result<CommitCounts> write(const StoreBatch& batch);

 private:
  struct Statements;

  explicit BatchWriter(std::unique_ptr<Statements> statements);
  [[nodiscard]] Result<void> put_intervals(const StoreBatch& batch, CommitCounts& counts);
  [[nodiscard]] Result<void> put_interval(const StoreBatch::Interval& interval,
                                          const std::optional<std::int64_t>& edit,
                                          CommitCounts& counts);
  [[nodiscard]] Result<std::optional<StoredInterval>> latest(std::uint32_t meter,
                                                             metering::Instant start);
  /// Whether the meter has no interval from `start` on, as that of a live meter has not.
  [[nodiscard]] Result<bool> is_newer_than_all(std::uint32_t meter, metering::Instant start);
  [[nodiscard]] Result<void> put_registers(const StoreBatch& batch);
  [[nodiscard]] Result<void> put_samples(const StoreBatch& batch);
  [[nodiscard]] Result<bool> count_event(const StoreEvent& event);
  [[nodiscard]] Result<void> put_events(const StoreBatch& batch);
  [[nodiscard]] Result<void> reopen_months(const StoreBatch& batch);

  std::unique_ptr<Statements> statements_;
  /// Of each meter, no interval starts later. After a rollback it may name one that is not there.
  std::unordered_map<std::uint32_t, metering::Instant> newest_;
};

}  // namespace recald::sqlite
