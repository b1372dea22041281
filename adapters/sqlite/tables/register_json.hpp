/// A register's state as text, stored in one column.
#pragma once

#include <string>
#include <string_view>

#include "adapters/ports/store.hpp"

namespace recald::sqlite {

/// Writes JSON; doubles keep every bit, times are in seconds since 1970.
[[nodiscard]] std::string to_json(const RegisterState& state);

/// @return the state, or malformed, saying what is missing or wrong.
[[nodiscard]] Result<RegisterState> register_from_json(std::string_view text);

}  // namespace recald::sqlite
