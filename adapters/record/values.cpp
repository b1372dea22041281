#include "adapters/record/values.hpp"

#include <fmt/format.h>

#include "adapters/system/files/sha256.hpp"

namespace recald::record {

std::string text_of(std::string_view text) {
  std::string kept{text};
  std::erase(kept, '\0');
  return kept;
}

Result<JobKind> parse_job_kind(std::string_view name) {
  for (const JobKind kind : {JobKind::calibration, JobKind::diagnosis}) {
    if (recald::name_of(kind) == name) return kind;
  }
  return failure(ErrorCode::malformed, fmt::format("the record has a job of kind '{}'", name));
}

std::string sha256_of(std::string_view bytes) {
  system::Sha256 digest;
  digest.add(bytes);
  return digest.hex();
}

}  // namespace recald::record
