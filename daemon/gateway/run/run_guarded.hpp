/// A loop that continues whatever its calls throw.
#pragma once

#include <utility>  // Boost 1.74's Asio uses std::exchange without it

#include <boost/asio/io_context.hpp>
#include <functional>

#include "adapters/ports/loop.hpp"
#include "adapters/ports/store.hpp"

namespace recald::daemon {

/// Runs the context until it is stopped. What a call or a coroutine throws becomes an event
/// "unforeseen", the same one after the other once an hour, and all others go on.
/// @param loop  On that context.
void run_guarded(boost::asio::io_context& context, const Loop& loop,
                 const std::function<void(StoreEvent)>& note);

}  // namespace recald::daemon
