/// When a page was made, as it says itself.
#pragma once

#include <string>

namespace recald::daemon {

/// The wall clock, which no command reads elsewhere; SOURCE_DATE_EPOCH makes pages repeatable.
[[nodiscard]] std::string generated_at();

}  // namespace recald::daemon
