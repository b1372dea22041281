/// A JSON schema of the site file, for editors that complete, explain and check keys.
#pragma once

#include <string>

namespace recald::daemon {

/// JSON Schema draft 7, made from daemon/examples/every-key.toml: its keys, the types of their
/// values, and its comments as descriptions. What a value may be is left to `recald check`.
[[nodiscard]] std::string site_schema();

}  // namespace recald::daemon
