/// What becomes of an exception that a coroutine does not catch.
#pragma once

#include <exception>

namespace recald::asio {

/// In the place of `detached`, which forgets it: it leaves the run() of the coroutine's context, as
/// what any other call throws does.
inline constexpr auto rethrown = [](const std::exception_ptr& thrown) {
  if (thrown) std::rethrow_exception(thrown);
};

}  // namespace recald::asio
