/// SQLite as values: a database, its statements, its transactions. Every failure is a `Result`.
///
/// One connection writes and alone checkpoints; readers open their own, read only. That is not
/// taste: before 3.51.3 two connections that write or checkpoint together could lose a write-ahead
/// log. Durability is `synchronous=FULL`: what is committed survives a power cut.
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

/// Told now and then that long work goes on.
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
  /// Whatever stands in another statement's row.
  Statement& bind_column(int parameter, const Statement& row, int column);

  /// The next row. @return whether there is one, or as Database::execute. At the end, or after a
  /// failure, the statement can be bound and run again.
  [[nodiscard]] Result<bool> step();
  /// Runs a statement that gives no rows.
  [[nodiscard]] Result<void> run();
  /// Gives up the rows that are left. A row that is not read to its end holds the database open.
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
  };

  /// Opens, or with `read_write` creates. ":memory:" lives as long as the value.
  /// @return io_failed  cannot be opened, disk full, in use by another writer for 5 s;
  ///         malformed  no database, or a damaged one.
  [[nodiscard]] static Result<Database> open(const std::filesystem::path& file,
                                             const Options& options);

  ~Database();
  Database(Database&&) noexcept;
  Database& operator=(Database&&) noexcept;

  /// One or several statements without rows.
  /// @return io_failed (the operating system, a full disk, a lock), malformed (damage), or
  ///         invalid_value (a constraint was violated).
  [[nodiscard]] Result<void> execute(const std::string& sql);
  /// @pre the text is right; a wrong one is our bug and asserted.
  [[nodiscard]] Result<Statement> prepare(std::string_view sql);

  /// Everything that `work` does happens, or nothing of it. `work` returns a Result. Within another
  /// transaction it is a part of that one: what fails here is undone here.
  template <class Work>
  [[nodiscard]] auto transaction(Work&& work) -> decltype(work()) {
    const auto is_part = begin();
    if (!is_part) return tl::unexpected(is_part.error());
    auto result = work();
    if (!result) {
      roll_back(*is_part);
      return result;
    }
    if (auto committed = finish(*is_part); !committed) {
      roll_back(*is_part);
      return tl::unexpected(committed.error());
    }
    return result;
  }

  /// Called now and then while a statement runs for long; may be empty.
  void on_progress(OnProgress call);

  /// Ends what runs in another thread, which then fails. @pre the database lives meanwhile
  void interrupt();

  /// What is damaged, in SQLite's words; empty when nothing is.
  [[nodiscard]] Result<std::string> quick_check();

 private:
  friend class Backup;
  struct Impl;
  explicit Database(std::unique_ptr<Impl> impl);
  [[nodiscard]] Result<bool> begin();  ///< @return whether it is part of another transaction.
  [[nodiscard]] Result<void> finish(bool is_part);
  void roll_back(bool is_part);
  std::unique_ptr<Impl> impl_;
};

}  // namespace recald::sqlite
