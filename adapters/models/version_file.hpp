/// One version of a site's model as a JSON file.
///
/// The file is named after the SHA-256 of its content without `version`, `status` and `created_at`,
/// written without blanks and with sorted keys. Equal content has one name, and damage shows.
#pragma once

#include <filesystem>
#include <string>

#include "core/diagnosis/model_version.hpp"
#include "core/result.hpp"

namespace recald::models {

/// Sets the version's name from its content.
/// @return not_finite for a NaN or infinity among its numbers; invalid_value for text that is not
///         UTF-8, or parameters whose draws differ in number.
[[nodiscard]] Result<diagnosis::ModelVersion> named_by_content(diagnosis::ModelVersion version);

/// The version as indented JSON. @pre from `named_by_content`, `read_version_file` or the base
/// version
[[nodiscard]] std::string version_json(const diagnosis::ModelVersion& version);

/// @return not_found; or malformed with file and reason: not JSON, a file name that does not match
///         the content, a field that is missing or makes no sense.
[[nodiscard]] Result<diagnosis::ModelVersion> read_version_file(const std::filesystem::path& file);

}  // namespace recald::models
