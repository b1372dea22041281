/// A connection to PostgreSQL, by libpq.
///
/// Blocking; one thread at a time. A connection that broke is made again by the next statement
/// outside a transaction.
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <stop_token>
#include <string>
#include <string_view>
#include <vector>

#include "core/result.hpp"

namespace recald::postgres {

/// A parameter as text, as PostgreSQL reads it; nothing: NULL. Bytes go as `bytea` in hexadecimal.
using Parameter = std::optional<std::string>;

[[nodiscard]] Parameter bytes(std::string_view data);

/// The rows that a statement gave.
class Rows {
 public:
  [[nodiscard]] int size() const;
  [[nodiscard]] bool is_null(int row, int column) const;
  [[nodiscard]] std::string_view text(int row, int column) const;
  [[nodiscard]] std::int64_t integer(int row, int column) const;
  [[nodiscard]] double real(int row, int column) const;
  [[nodiscard]] std::string bytes(int row, int column) const;
  /// Of an INSERT, UPDATE or DELETE.
  [[nodiscard]] std::int64_t affected() const;

 private:
  friend class Connection;
  std::shared_ptr<void> result_;
};

class Connection {
 public:
  /// @param url       "postgresql://user@host:5432/fleet?sslmode=verify-full", without a password
  /// @param password  Empty: none is needed.
  /// @return io_failed: it cannot be reached or refuses us; the sentence names the server and not
  /// the password.
  [[nodiscard]] static Result<std::unique_ptr<Connection>> open(const std::string& url,
                                                                const std::string& password);
  ~Connection();

  /// One statement with $1, $2 …
  /// @return or io_failed: the server is away, shut down or out of room: later it may go;
  /// malformed: the server refuses
  ///         the statement, in its words.
  Result<Rows> run(const std::string& statement, std::span<const Parameter> parameters = {});

  /// Several statements without parameters, separated by semicolons.
  Result<void> run_all(const std::string& statements);

  /// All that `work` does at once (READ COMMITTED); a failure leaves no trace. Tried once more
  /// after a serialisation failure or a deadlock.
  Result<void> transaction(const std::function<Result<void>()>& work);

  /// Rows into a table by COPY: one string a column, NULL absent.
  Result<void> copy_in(const std::string& table_and_columns,
                       std::span<const std::vector<Parameter>> rows);

  /// Calls `visit` for each row of a long answer, a row at a time in constant memory.
  Result<void> for_each(const std::string& statement, std::span<const Parameter> parameters,
                        const std::function<Result<void>(const Rows& one, int row)>& visit);

  /// Waits until the channel is notified, the time is over or it is told to stop. LISTEN first,
  /// once.
  /// @return whether it was notified.
  Result<bool> wait_for(const std::string& channel, std::chrono::milliseconds time_max,
                        const std::stop_token& stop);
};

}  // namespace recald::postgres
