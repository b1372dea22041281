#include "adapters/record/values.hpp"

#include <fmt/format.h>

#include "adapters/system/sha256.hpp"

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

std::string sha256_of(const std::map<std::string, std::string>& files) {
  system::Sha256 digest;
  for (const auto& [name, bytes] : files) {
    digest.add(fmt::format("{}:{}{}:", name.size(), name, bytes.size()));
    digest.add(bytes);
  }
  return digest.hex();
}

Result<std::map<std::string, std::string>> put_files(
    postgres::Connection& connection, const std::map<std::string, std::string>& files) {
  std::map<std::string, std::string> sums;
  for (const auto& [name, bytes] : files) {
    const std::string& sum = sums[name] = sha256_of(bytes);
    const auto known = connection.run("SELECT 1 FROM file WHERE sha256 = $1", {sum});
    if (!known) return tl::unexpected(known.error());
    if (known->size() > 0) continue;
    const auto put = connection.run("INSERT INTO file VALUES ($1, $2) ON CONFLICT DO NOTHING",
                                    {sum, postgres::bytes(bytes)});
    if (!put) return tl::unexpected(put.error());
  }
  return sums;
}

std::map<std::string, std::string> named_bytes(const postgres::Rows& rows) {
  std::map<std::string, std::string> files;
  for (int i = 0; i < rows.size(); ++i) files.emplace(rows.text(i, 0), rows.bytes(i, 1));
  return files;
}

}  // namespace recald::record
