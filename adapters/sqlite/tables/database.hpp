/// SQLite as values: a database, its statements, its transactions. Every failure is a `Result`.
///
/// One connection writes, and only it runs checkpoints; readers open their own, read only. This is
/// required: before SQLite 3.51.3, two connections that write or run checkpoints at once could lose
/// a write-ahead log. Durability is `synchronous=FULL`: committed data survive a power cut.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "core/result.hpp"

namespace recald::sqlite {

/// Called from time to time during long work.
using OnProgress = std::function<void()>;

/// A prepared statement. Parameters and columns count from 0.
class Statement {
 public:
  ~Statement();
  Statement(Statement&&) noexcept;
  Statement& operator=(Statement&&) noexcept;

  Statement& bind(int parameter, std::int64_t value);
  Statement& bind(int parameter, double value);  ///< NaN becomes NULL.
  Statement& bind(int parameter, std::string_view text);
  Statement& bind_null(int parameter);
  /// Binds a column of another statement's row, of any type.
  Statement& bind_column(int parameter, const Statement& row, int column);

  /// Moves to the next row. @return whether there is one, or as Database::execute. At the end, or
  /// after a failure, the statement can be bound and run again.
  [[nodiscard]] Result<bool> step();
  /// Runs a statement that returns no rows.
  [[nodiscard]] Result<void> run();
  /// Drops the remaining rows. A statement with rows left holds the database open.
  void reset();

  [[nodiscard]] std::int64_t integer(int column) const;
  [[nodiscard]] double real(int column) const;  ///< NULL is NaN.
  [[nodiscard]] std::string text(int column) const;
  [[nodiscard]] bool is_null(int column) const;

 private:
  friend class Database;
  struct Impl;
  explicit Statement(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

class Database {
 public:
  enum class Access { read_write, read_only };

  struct Options {
    Access access = Access::read_write;
    std::string vfs;  ///< Name of a registered file system; empty: SQLite's own.
    /// Nobody writes the file meanwhile: it is read without its log, and no file is made beside it.
    bool is_still = false;
  };

  /// Opens a database, or with `read_write` creates it. ":memory:" lives as long as the object.
  /// @return io_failed  cannot be opened, disk full, in use by another writer for 5 s;
  ///         malformed  not a database, or a damaged one.
  [[nodiscard]] static Result<Database> open(const std::filesystem::path& file,
                                             const Options& options);

  ~Database();
  Database(Database&&) noexcept;
  Database& operator=(Database&&) noexcept;

  /// Runs one or several statements without rows.
  /// @return io_failed (the operating system, a full disk, a lock), malformed (damage), or
  ///         invalid_value (a constraint was violated).
  [[nodiscard]] Result<void> execute(const std::string& sql);
  /// @pre the SQL is right; a mistake is our bug and is asserted.
  [[nodiscard]] Result<Statement> prepare(std::string_view sql);

  /// Does everything in `work`, or nothing. `work` returns a Result. Within another transaction it
  /// becomes part of that one, and only its own changes are undone on failure.
  template <class Work>
  [[nodiscard]] auto transaction(Work&& work) -> decltype(work()) {
    const auto is_part = TRY(begin());
    auto result = work();
    if (!result) {
      roll_back(is_part);
      return result;
    }
    if (auto committed = finish(is_part); !committed) {
      roll_back(is_part);
      return tl::unexpected(committed.error());
    }
    return result;
  }

  /// Called from time to time during a long statement; may be empty.
  void on_progress(OnProgress call);

  /// Interrupts the running statement from another thread; it then fails. @pre the
  /// database stays alive
  void interrupt();

  /// The damage in SQLite's words; empty if there is none.
  [[nodiscard]] Result<std::string> quick_check();

 private:
  friend class Backup;
  struct Impl;
  explicit Database(std::unique_ptr<Impl> impl);
  [[nodiscard]] Result<bool> begin();  ///< @return whether it is part of another transaction.
  [[nodiscard]] Result<void> finish(bool is_part);
  void roll_back(bool is_part);
  /// Runs a statement without rows; `kept` is the prepared one, or empty at the first call.
  template <class Handle>
  [[nodiscard]] Result<void> run_kept(Handle& kept, std::string_view sql);
  std::unique_ptr<Impl> impl_;
};

}  // namespace recald::sqlite
