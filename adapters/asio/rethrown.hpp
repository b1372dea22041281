/// What happens to an exception that a coroutine does not catch.
#pragma once

#include <exception>

namespace recald::asio {

/// Replaces `detached`, which drops the exception: here it leaves the run() of the coroutine's
/// context, like an exception of any other call.
inline constexpr auto rethrown = [](const std::exception_ptr& thrown) {
  if (thrown) std::rethrow_exception(thrown);
};

}  // namespace recald::asio
