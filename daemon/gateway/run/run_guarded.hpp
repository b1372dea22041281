/// Runs a loop that continues when its calls throw.
#pragma once

#include <utility>  // Boost 1.74's Asio uses std::exchange without it

#include <boost/asio/io_context.hpp>
#include <functional>

#include "adapters/ports/loop.hpp"
#include "adapters/ports/store.hpp"

namespace recald::daemon {

/// Runs the context until it is stopped. An exception of a call or coroutine becomes an event
/// "unforeseen", at most once an hour while it repeats, and everything else continues.
/// @param loop  Runs on that context.
void run_guarded(boost::asio::io_context& context, const Loop& loop,
                 const std::function<void(StoreEvent)>& note);

}  // namespace recald::daemon
