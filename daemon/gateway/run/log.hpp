/// The log: what others have sent stands in it as one line of characters to be seen.
#pragma once

namespace recald::daemon {

/// Sends what spdlog is given to the standard error stream, a line an event, times in UTC.
void open_log();

}  // namespace recald::daemon
