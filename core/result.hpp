/// Failure as a value: what the data or the world can get wrong.
///
/// Our own bugs are assertions; nothing in core throws on bad data.
#pragma once

#include <string>
#include <string_view>
#include <tl/expected.hpp>
#include <type_traits>
#include <utility>

#include "core/text/printable.hpp"

namespace recald {

/// What kind of thing went wrong. The message carries what, where, which value and what to do.
enum class ErrorCode {
  invalid_value,    ///< A value from outside makes no sense (prior with min > mode, unknown unit).
  malformed,        ///< Text that cannot be parsed (wrong header, bad number, bad time stamp).
  not_found,        ///< A file, meter, key or zone that does not exist.
  io_failed,        ///< The operating system refused a read or a write.
  not_enough_data,  ///< Too few readings, months or draws for the answer asked for.
  not_finite,       ///< NaN or infinity where a number is needed.
  not_positive_definite,  ///< A covariance that has no Cholesky factor.
  out_of_range,           ///< A value outside what the component supports (an instant after 2100).
  unsupported,            ///< Understood, but this version does not do it.
  cancelled,              ///< The caller asked to stop.
};

struct Error {
  /// @param text  One sentence, which may quote what others wrote: control characters are written
  ///              out here, so that no caller can forget it.
  Error(ErrorCode kind, std::string_view text) : code{kind}, message{printable(text)} {}

  ErrorCode code;
  std::string message;
};

template <class T>
using Result = tl::expected<T, Error>;

/// Shorthand for `return tl::unexpected(Error{code, message})`.
[[nodiscard]] inline tl::unexpected<Error> failure(ErrorCode code, std::string_view message) {
  return tl::unexpected<Error>(Error{code, message});
}

/// What a Result that is no failure holds, moved out of a Result that nobody else has.
template <class R>
auto value_of(R&& result) {
  if constexpr (!std::is_void_v<typename std::remove_cvref_t<R>::value_type>) {
    return *std::forward<R>(result);
  }
}

}  // namespace recald

/// The value of a Result; where it is a failure, the function that this stands in returns its
/// error.
///
/// Only as a whole statement, or as all that initialises or is assigned (`const auto x =
/// TRY(f());`): of a larger expression, GCC 12 does not destroy what was made before. In a
/// coroutine it has no place: that returns by co_return.
#define TRY(...) RECALD_TRY_AS(RECALD_JOINED(tried_, __COUNTER__), __VA_ARGS__)

#define RECALD_TRY_AS(tried, ...)                                                    \
  __extension__({                                                                    \
    auto&& tried = (__VA_ARGS__);                                                    \
    if (!tried) return tl::unexpected(std::forward<decltype(tried)>(tried).error()); \
    ::recald::value_of(std::forward<decltype(tried)>(tried));                        \
  })

// Two macros, since the operator ## takes its operands as they are written.
#define RECALD_JOINED(left, right) RECALD_JOINED_AS_WRITTEN(left, right)
#define RECALD_JOINED_AS_WRITTEN(left, right) left##right
