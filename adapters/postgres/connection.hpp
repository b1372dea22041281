/// A connection to PostgreSQL, by libpq. (A call of libpqxx waits for as long as the server takes,
/// and what it had connected stays broken.)
///
/// Blocking; one thread at a time. A connection that broke is made again by the next statement
/// outside a transaction. A peer that vanished is an error after half a minute at most, for us and
/// for the server, which then lets go of what the connection had locked.
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <stop_token>
#include <string>
#include <string_view>
#include <vector>

#include "core/result.hpp"

namespace recald::postgres {

/// A parameter as text, as PostgreSQL reads it; nothing: NULL.
using Parameter = std::optional<std::string>;

[[nodiscard]] Parameter integer(std::int64_t value);
[[nodiscard]] Parameter real(double value);  ///< NaN becomes NULL.
/// As `bytea`, in hexadecimal.
[[nodiscard]] Parameter bytes(std::string_view data);

/// A parameter that holds many values, for `unnest($1::bigint[])`: a statement takes all rows of a
/// batch at once.
class Array {
 public:
  Array& add(std::int64_t value);
  Array& add(double value);  ///< NaN becomes NULL.
  Array& add(std::string_view text);

  [[nodiscard]] Parameter parameter() const { return text_ + '}'; }

 private:
  void begin_value();

  std::string text_ = "{";
};

/// The rows that a statement gave; rows and columns count from 0.
class Rows {
 public:
  [[nodiscard]] int size() const;
  [[nodiscard]] bool is_null(int row, int column) const;
  /// As long as the rows; the next three as well.
  [[nodiscard]] std::string_view text(int row, int column) const;
  [[nodiscard]] std::int64_t integer(int row, int column) const;
  [[nodiscard]] double real(int row, int column) const;  ///< NULL is NaN.
  [[nodiscard]] bool boolean(int row, int column) const;
  [[nodiscard]] std::string bytes(int row, int column) const;
  /// Of an INSERT, UPDATE or DELETE.
  [[nodiscard]] std::int64_t affected() const;

 private:
  friend class Connection;
  std::shared_ptr<void> result_;
};

/// How long somebody waits for a server that does not answer: stopped, say, with its disk.
struct Patience {
  std::chrono::milliseconds answer_max{60'000};  ///< Of a statement, or of the next row of many.
  /// Ends a wait within three seconds: what a server that is well has still to be told gets
  /// through.
  std::stop_token stop = {};
};

class Connection {
 public:
  /// @param url       "postgresql://user@host:5432/fleet?sslmode=verify-full", without a password
  /// @param password  Empty: none is needed.
  /// @return invalid_value: no such URL, or one with a password; io_failed: the server cannot be
  ///         reached or refuses us. The sentence names the server and not the password.
  [[nodiscard]] static Result<std::unique_ptr<Connection>> open(const std::string& url,
                                                                const std::string& password,
                                                                const Patience& patience = {});
  ~Connection();

  /// One statement with $1, $2 … The server keeps the plan of each text: there must be few.
  /// @return or io_failed: the server is away, shut down, locked, out of room or does not answer:
  ///         later it may go;
  ///         malformed: the server refuses the statement, in its words.
  Result<Rows> run(const std::string& statement, const std::vector<Parameter>& parameters = {});

  /// Several statements without parameters, separated by semicolons: all or none.
  Result<void> run_all(const std::string& statements);

  /// All that `work` does at once (READ COMMITTED); a failure leaves no trace. Tried again, twice,
  /// after a deadlock, a serialisation failure or a row that somebody else inserted first. Where
  /// the connection is lost while it commits, nobody knows (io_failed): the caller must be able to
  /// do it again.
  /// @pre not within another
  Result<void> transaction(const std::function<Result<void>()>& work);

  /// Calls `visit` for each row of a long answer in constant memory; the row is number 0 of `row`.
  /// The first error of `visit` ends it.
  Result<void> for_each(const std::string& statement, const std::vector<Parameter>& parameters,
                        const std::function<Result<void>(const Rows& row)>& visit);

  /// Waits until the channel is notified, the time is over or it is told to stop.
  /// @return whether something may have come since the last call: notified, or the connection
  ///         listens from now on and what came before is not known.
  Result<bool> wait_for(const std::string& channel, std::chrono::milliseconds time_max,
                        const std::stop_token& stop);

 private:
  struct Impl;
  explicit Connection(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

/// Of libpq: "15.8".
[[nodiscard]] std::string library_version();

}  // namespace recald::postgres
