/// Values of ours as parameters of statements and as columns of their rows: times are seconds since
/// 1970, months text, enums their numbers; what is absent, and NaN, is NULL.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "adapters/ports/store.hpp"
#include "adapters/sqlite/tables/database.hpp"
#include "core/absent.hpp"

namespace recald::sqlite {

inline std::int64_t seconds_of(metering::Instant t) { return t.time_since_epoch().count(); }
inline metering::Instant instant_of(std::int64_t seconds) {
  return metering::Instant{std::chrono::seconds{seconds}};
}

template <class T>
void bind_value(Statement& statement, int parameter, const T& value) {
  if constexpr (is_optional<T>) {
    if (value) {
      bind_value(statement, parameter, *value);
    } else {
      statement.bind_null(parameter);
    }
  } else if constexpr (std::is_floating_point_v<T>) {
    statement.bind(parameter, value);
  } else if constexpr (std::is_integral_v<T> || std::is_enum_v<T>) {
    statement.bind(parameter, static_cast<std::int64_t>(value));
  } else if constexpr (std::is_same_v<T, std::chrono::seconds>) {
    statement.bind(parameter, std::int64_t{value.count()});
  } else if constexpr (std::is_same_v<T, metering::Instant>) {
    statement.bind(parameter, seconds_of(value));
  } else if constexpr (std::is_same_v<T, metering::Month>) {
    statement.bind(parameter, std::string_view{metering::to_string(value)});
  } else {
    statement.bind(parameter, std::string_view{value});
  }
}

/// Binds a statement's parameters, from the first on. @return the statement
template <class... Values>
Statement& bound(Statement& statement, const Values&... values) {
  int parameter = 0;
  (bind_value(statement, parameter++, values), ...);
  return statement;
}

/// A row's columns from the first on, each as the type of what it initialises: in braces, in order.
/// What may be NULL names its type.
class Columns {
 public:
  explicit Columns(const Statement& row) : row_(&row) {}

  template <class T>
  T next() {
    if constexpr (is_optional<T>) {
      if (!row_->is_null(at_)) return next<typename T::value_type>();
      ++at_;
      return {};
    } else if constexpr (std::is_same_v<T, bool>) {
      return row_->integer(at_++) != 0;
    } else if constexpr (std::is_floating_point_v<T>) {
      return row_->real(at_++);
    } else if constexpr (std::is_integral_v<T> || std::is_enum_v<T>) {
      return static_cast<T>(row_->integer(at_++));
    } else if constexpr (std::is_same_v<T, std::chrono::seconds>) {
      return T{row_->integer(at_++)};
    } else if constexpr (std::is_same_v<T, metering::Instant>) {
      return instant_of(row_->integer(at_++));
    } else {
      static_assert(std::is_same_v<T, std::string>);
      return row_->text(at_++);
    }
  }
  template <class T>
  operator T() {  // NOLINT(google-explicit-constructor): a column has no type of its own
    return next<T>();
  }
  /// @return malformed for a text that is no month.
  [[nodiscard]] Result<metering::Month> month() {
    return metering::parse_month(next<std::string>());
  }

 private:
  const Statement* row_;
  int at_ = 0;
};

template <class T>
inline constexpr bool is_result = false;
template <class T>
inline constexpr bool is_result<Result<T>> = true;

/// Calls visit(row) for each row. @return as Database::execute
template <class Visit>
[[nodiscard]] Result<void> for_each_row(Statement& query, Visit visit) {
  for (;;) {
    const auto row = TRY(query.step());
    if (!row) return {};
    visit(query);
  }
}

/// @param read  Makes a value of the columns, or a Result of it.
/// @return a value a row, or as Database::execute, or what a row failed with.
template <class Read>
[[nodiscard]] auto all_rows(Statement& query, Read read) {
  using Made = std::invoke_result_t<Read, Columns&>;
  const auto as_result = [&](Columns columns) {
    if constexpr (is_result<Made>) {
      return std::invoke(read, columns);
    } else {
      return Result<Made>{std::invoke(read, columns)};
    }
  };
  using Value = typename decltype(as_result(std::declval<Columns>()))::value_type;
  return [&]() -> Result<std::vector<Value>> {
    std::vector<Value> values;
    for (;;) {
      const auto row = TRY(query.step());
      if (!row) return values;
      auto value = TRY(as_result(Columns{query}));
      values.push_back(std::move(value));
    }
  }();
}

inline constexpr auto kIntervalColumns = "t_start, revision, mean_kW, validity, late, reasons";

/// @pre columns as in `kIntervalColumns`
inline StoredInterval read_interval(Columns columns, std::uint32_t meter) {
  StoredInterval interval{.reading = {.meter = meter}};
  metering::Reading& reading = interval.reading;
  reading.start = columns;
  interval.revision = columns;
  reading.mean_kW = columns;
  reading.validity = columns;
  reading.late = columns;
  reading.reasons = columns;
  return interval;
}

}  // namespace recald::sqlite
