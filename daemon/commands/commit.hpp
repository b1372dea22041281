/// The commit that was built.
#pragma once

#include <string_view>

namespace recald::daemon {

/// As RECALD_COMMIT or the checkout says; empty: unknown.
[[nodiscard]] std::string_view built_commit();

}  // namespace recald::daemon
