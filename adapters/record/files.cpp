#include "adapters/record/files.hpp"

#include <fmt/format.h>

#include "adapters/record/values.hpp"
#include "adapters/system/files/sha256.hpp"

namespace recald::record {
namespace {

using postgres::Connection;
using postgres::integer;

constexpr std::string_view kScript = "<script>";
constexpr std::string_view kScriptEnd = "</script>";
/// Shorter ones gain less than a row costs.
constexpr std::size_t kLongScript = 64 * 1024;

Result<bool> has_file(Connection& connection, const std::string& sum) {
  const auto known = TRY(connection.run("SELECT 1 FROM file WHERE sha256 = $1", {sum}));
  return known.size() > 0;
}

/// @param bytes  Nothing: it is kept in parts.
Result<void> put_row(Connection& connection, const std::string& sum,
                     const postgres::Parameter& bytes) {
  TRY(connection.run("INSERT INTO file VALUES ($1, $2) ON CONFLICT DO NOTHING", {sum, bytes}));
  return {};
}

Result<void> put_parts(Connection& connection, const std::string& sum,
                       const std::vector<std::string_view>& parts) {
  if (auto put = put_row(connection, sum, {}); !put) return put;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const std::string part = sha256_of(parts[i]);
    const auto known = TRY(has_file(connection, part));
    if (!known) {
      if (auto put = put_row(connection, part, postgres::bytes(parts[i])); !put) return put;
    }
    TRY(connection.run("INSERT INTO file_part VALUES ($1, $2, $3) ON CONFLICT DO NOTHING",
                       {sum, integer(static_cast<std::int64_t>(i)), part}));
  }
  return {};
}

}  // namespace

std::string sha256_of(const std::map<std::string, std::string>& files) {
  system::Sha256 digest;
  for (const auto& [name, bytes] : files) {
    digest.add(fmt::format("{}:{}{}:", name.size(), name, bytes.size()));
    digest.add(bytes);
  }
  return digest.hex();
}

std::vector<std::string_view> parts_of(std::string_view page) {
  std::vector<std::string_view> parts;
  std::size_t cut = 0;
  for (std::size_t at = 0; (at = page.find(kScript, at)) != std::string_view::npos;) {
    const std::size_t begin = at + kScript.size();
    const std::size_t end = page.find(kScriptEnd, begin);
    if (end == std::string_view::npos) break;
    at = end;
    if (end - begin < kLongScript) continue;
    parts.push_back(page.substr(cut, begin - cut));
    parts.push_back(page.substr(begin, end - begin));
    cut = end;
  }
  parts.push_back(page.substr(cut));
  return parts;
}

Result<std::map<std::string, std::string>> put_files(
    Connection& connection, const std::map<std::string, std::string>& files) {
  std::map<std::string, std::string> sums;
  for (const auto& [name, bytes] : files) {
    const std::string& sum = sums[name] = sha256_of(bytes);
    const auto known = TRY(has_file(connection, sum));
    if (known) continue;
    const auto parts = parts_of(bytes);
    TRY(parts.size() > 1 ? put_parts(connection, sum, parts)
                         : put_row(connection, sum, postgres::bytes(bytes)));
  }
  return sums;
}

std::map<std::string, std::string> named_bytes(const postgres::Rows& rows) {
  std::map<std::string, std::string> files;
  for (int i = 0; i < rows.size(); ++i) files.emplace(rows.text(i, 0), rows.bytes(i, 1));
  return files;
}

}  // namespace recald::record
