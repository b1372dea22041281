/// What a certificate says of itself.
#pragma once

#include <filesystem>

#include "core/metering/civil_time.hpp"
#include "core/result.hpp"

namespace recald::http {

/// When the first certificate of a PEM file ends.
/// @return the time; io_failed: cannot be read; malformed: has no certificate.
[[nodiscard]] Result<metering::Instant> end_of_certificate(const std::filesystem::path& file);

}  // namespace recald::http
