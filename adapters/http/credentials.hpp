/// Access control: one token for all clients, sent as a Bearer token or as a password.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "core/result.hpp"

namespace recald::http {

/// Whether an Authorization header carries the token: "Bearer TOKEN" from programs, or "Basic …"
/// with any name and the token as password, which browsers can send. The time taken does not depend
/// on how much of the token was right.
/// @pre token is not empty
[[nodiscard]] bool carries_token(std::string_view authorization, std::string_view token);

/// Reads the token from a file, without surrounding white space.
/// @return the token; or not_found, io_failed; invalid_value if it is shorter than 16 characters,
///         has characters other than letters, digits and -._~+/=, or if anyone but the owner may
///         read the file.
[[nodiscard]] Result<std::string> read_token_file(const std::filesystem::path& file);

/// Reads a password that a server outside asks for: the one line of a file, of any characters.
/// @return the password; or not_found, io_failed; invalid_value as above, or if it is not one line.
[[nodiscard]] Result<std::string> read_password_file(const std::filesystem::path& file);

}  // namespace recald::http
