/// A register's state as text, for files that are no stores.
#pragma once

#include <string>
#include <string_view>

#include "adapters/ports/interval_store.hpp"

namespace recald::stores {

/// JSON, without line breaks; reading it gives the same to the last bit.
[[nodiscard]] std::string register_text(const RegisterState& state);

/// @return the state, or malformed, saying what is missing or wrong.
[[nodiscard]] Result<RegisterState> read_register_text(std::string_view text);

}  // namespace recald::stores
