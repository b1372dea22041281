/// One version of a site's model as a JSON file.
///
/// The file's name is the SHA-256 of its content without `version`, `status` and `created_at`,
/// written without blanks and with sorted keys: equal content has one name, and damage shows.
#pragma once

#include <filesystem>
#include <string>

#include "core/diagnosis/model_version.hpp"
#include "core/result.hpp"

namespace recald::models {

/// The version with the name that its content gives it.
/// @return not_finite for a NaN or infinity among its numbers; invalid_value for text that is not
///         UTF-8, or parameters whose draws differ in number.
[[nodiscard]] Result<diagnosis::ModelVersion> named_by_content(diagnosis::ModelVersion version);

/// All of it, indented. @pre from `named_by_content`, `read_version_file` or the base version
[[nodiscard]] std::string version_json(const diagnosis::ModelVersion& version);

/// @return not_found; or malformed with file and reason: no JSON, content that does not give the
///         file's name, a field that is missing or makes no sense.
[[nodiscard]] Result<diagnosis::ModelVersion> read_version_file(const std::filesystem::path& file);

}  // namespace recald::models
