/// How a worker waits for a record or a broker that is away.
#pragma once

#include <functional>
#include <stop_token>
#include <string>

#include "core/result.hpp"

namespace recald::daemon {

/// Takes a sentence for people; safe from any thread.
using Report = std::function<void(const std::string&)>;

/// Does `work`, and after a failure again, 5 s to 60 s apart, until it returns without one or is
/// asked to stop. Each new reason is reported once.
/// @param meanwhile  What does not happen then: "no jobs are done".
void keep_trying(const std::string& meanwhile, const std::function<Result<void>()>& work,
                 const Report& report, const std::stop_token& stop);

}  // namespace recald::daemon
