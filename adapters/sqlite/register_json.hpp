/// A register's state as text, for one column of the store.
#pragma once

#include <string>
#include <string_view>

#include "adapters/ports/store.hpp"

namespace recald::sqlite {

/// JSON; doubles to the last bit, times in seconds since 1970.
[[nodiscard]] std::string to_json(const RegisterState& state);

/// @return the state, or malformed with what is missing or wrong.
[[nodiscard]] Result<RegisterState> register_from_json(std::string_view text);

}  // namespace recald::sqlite
