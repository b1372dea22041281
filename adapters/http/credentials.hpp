/// Who may ask: one token for all, as a Bearer token or as a password.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "core/result.hpp"

namespace recald::http {

/// Whether an Authorization header carries the token: "Bearer TOKEN" from programs, or "Basic …"
/// with any name and the token as password, which is what browsers can send. How long it takes does
/// not depend on how much of the token was right.
/// @pre token is not empty
[[nodiscard]] bool carries_token(std::string_view authorization, std::string_view token);

/// The token in a file, without the white space around it.
/// @return or not_found, io_failed; invalid_value where it is shorter than 16 characters or has
///         others than letters, digits and -._~+/=, or where people other than the owner may read
///         the file.
[[nodiscard]] Result<std::string> read_token_file(const std::filesystem::path& file);

}  // namespace recald::http
