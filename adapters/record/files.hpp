/// Files in the record: bytes under their SHA-256, once.
///
/// A script that is part of many pages (a report draws its figures with one of half a megabyte) is
/// stored once beside them: such a page is kept in parts, and the view `whole_file` puts it
/// together.
#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "adapters/postgres/connection.hpp"
#include "core/result.hpp"

namespace recald::record {

/// SHA-256 of names and bytes, in order of the names.
[[nodiscard]] std::string sha256_of(const std::map<std::string, std::string>& files);

/// Cut where a long script of a page begins and ends; one part: there is none.
[[nodiscard]] std::vector<std::string_view> parts_of(std::string_view page);

/// @return by name, the SHA-256 of each
[[nodiscard]] Result<std::map<std::string, std::string>> put_files(
    postgres::Connection& connection, const std::map<std::string, std::string>& files);

/// Names and bytes that a statement gives as its first two columns.
[[nodiscard]] std::map<std::string, std::string> named_bytes(const postgres::Rows& rows);

}  // namespace recald::record
