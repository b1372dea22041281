#include "adapters/record/sites.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <utility>

#include "adapters/record/files.hpp"
#include "adapters/record/values.hpp"

namespace recald::record {
namespace {

using Json = nlohmann::ordered_json;
using postgres::integer;
using postgres::Rows;

template <class Value>
Json or_null(const std::optional<Value>& value) {
  return value ? Json(*value) : Json();
}

std::optional<double> number(const Json& value) {
  return value.is_number() ? std::optional{value.get<double>()} : std::nullopt;
}

std::string description_of(const SiteDescription& site) {
  return Json{{"name", site.name},
              {"use", site.use},
              {"climate", site.climate},
              {"latitude_deg", or_null(site.latitude_deg)},
              {"longitude_deg", or_null(site.longitude_deg)},
              {"floor_area_m2", or_null(site.floor_area_m2)},
              {"currency", site.currency},
              {"outputs", site.outputs},
              {"site_file", site.site_file},
              {"calibrate_from", metering::to_string(site.calibrate_from)}}
      .dump();
}

Result<SiteDescription> read_description(const std::string& id, std::string_view text) {
  try {
    const Json read = Json::parse(text);
    const auto from = TRY(metering::parse_month(read.at("calibrate_from").get<std::string>()));
    return SiteDescription{.id = id,
                           .name = read.at("name"),
                           .use = read.at("use"),
                           .climate = read.at("climate"),
                           .latitude_deg = number(read.at("latitude_deg")),
                           .longitude_deg = number(read.at("longitude_deg")),
                           .floor_area_m2 = number(read.at("floor_area_m2")),
                           .currency = read.at("currency"),
                           .outputs = read.at("outputs"),
                           .site_file = read.at("site_file"),
                           .files = {},
                           .calibrate_from = from};
  } catch (const Json::exception&) {
    return failure(
        ErrorCode::malformed,
        fmt::format("the record's description of site {} was not written by recald", id));
  }
}

Error unknown_site(const std::string& site) {
  return {ErrorCode::not_found,
          fmt::format("the record has no site {}: register it with recald fleet add", site)};
}

/// @pre within a transaction
Result<SiteVersion> put_version(postgres::Connection& connection, const SiteDescription& site,
                                const std::string& who) {
  auto described = site.files;
  const std::string description = description_of(site);
  described[""] = description;  // no file's name
  SiteVersion version{.sha256 = sha256_of(described)};

  auto known =
      TRY(connection.run("INSERT INTO site (id, version, added) VALUES ($1, 0, now()) "
                         "ON CONFLICT (id) DO UPDATE SET retired = NULL RETURNING number, version",
                         {site.id}));
  const auto number = known.integer(0, 0);
  version.number = static_cast<int>(known.integer(0, 1));
  const auto present =
      TRY(connection.run("SELECT sha256 FROM site_version WHERE site = $1 AND number = $2",
                         {integer(number), integer(version.number)}));
  if (present.size() == 1 && present.text(0, 0) == version.sha256) return version;

  version.is_new = true;
  ++version.number;
  const auto sums = TRY(put_files(connection, site.files));
  TRY(connection.run("INSERT INTO site_version VALUES ($1, $2, $3, $4::jsonb, now(), $5)",
                     {integer(number), integer(version.number), version.sha256, description, who}));
  for (const auto& [name, sum] : sums) {
    TRY(connection.run("INSERT INTO site_file VALUES ($1, $2, $3, $4)",
                       {integer(number), integer(version.number), name, sum}));
  }
  TRY(connection.run("UPDATE site SET version = $2 WHERE number = $1",
                     {integer(number), integer(version.number)}));
  TRY(connection.run(
      "INSERT INTO audit (who, action, subject, text) VALUES ($1, 'put_site', $2, $3)",
      {who, site.id, fmt::format("version {}, {}", version.number, version.sha256)}));
  return version;
}

}  // namespace

Result<SiteVersion> put_site(postgres::Connection& connection, const SiteDescription& site,
                             const std::string& who) {
  SiteVersion version;
  TRY(connection.transaction([&]() -> Result<void> {
    version = TRY(put_version(connection, site, who));
    return {};
  }));
  return version;
}

Result<void> retire_site(postgres::Connection& connection, const std::string& site,
                         const std::string& who) {
  const auto done = TRY(connection.run(
      "WITH retired AS (UPDATE site SET retired = now() WHERE id = $1 AND retired IS NULL "
      "RETURNING id) INSERT INTO audit (who, action, subject, text) "
      "SELECT $2, 'retire_site', id, '' FROM retired",
      {site, who}));
  if (done.affected() == 0) return tl::unexpected(unknown_site(site));
  return {};
}

Result<std::vector<RecordedSite>> sites(postgres::Connection& connection) {
  const auto rows = connection.run(
      "SELECT s.id, v.description, v.number, v.sha256, extract(epoch FROM s.added)::bigint, "
      "extract(epoch FROM s.heard)::bigint, extract(epoch FROM s.newest)::bigint "
      "FROM site s JOIN site_version v ON v.site = s.number AND v.number = s.version "
      "WHERE s.retired IS NULL ORDER BY s.id");
  if (!rows) return tl::unexpected(rows.error());
  const auto maybe = [&rows](int row, int column) {
    return rows->is_null(row, column) ? std::nullopt : std::optional{instant(*rows, row, column)};
  };
  std::vector<RecordedSite> found;
  for (int i = 0; i < rows->size(); ++i) {
    auto site = TRY(read_description(std::string{rows->text(i, 0)}, rows->text(i, 1)));
    found.push_back({.site = std::move(site),
                     .version = {.number = static_cast<int>(rows->integer(i, 2)),
                                 .sha256 = std::string{rows->text(i, 3)}},
                     .added = instant(*rows, i, 4),
                     .heard = maybe(i, 5),
                     .newest = maybe(i, 6)});
  }
  return found;
}

Result<SiteDescription> site_of_version(postgres::Connection& connection, const std::string& site,
                                        int version) {
  const auto rows = TRY(
      connection.run("SELECT v.description FROM site s JOIN site_version v ON v.site = s.number "
                     "WHERE s.id = $1 AND v.number = $2",
                     {site, integer(version)}));
  if (rows.size() == 0) return tl::unexpected(unknown_site(site));
  auto read = read_description(site, rows.text(0, 0));
  if (!read) return read;
  const auto files = TRY(
      connection.run("SELECT n.name, f.bytes FROM site s JOIN site_file n ON n.site = s.number "
                     "JOIN whole_file f ON f.sha256 = n.sha256 WHERE s.id = $1 AND n.number = $2",
                     {site, integer(version)}));
  read->files = named_bytes(files);
  return read;
}

Result<std::vector<AuditEntry>> audited(postgres::Connection& connection, int limit) {
  const auto rows = TRY(connection.run(
      "SELECT extract(epoch FROM time)::bigint, who, action, subject, text, role FROM audit "
      "ORDER BY number DESC LIMIT $1",
      {integer(limit)}));
  std::vector<AuditEntry> entries;
  for (int i = 0; i < rows.size(); ++i) {
    entries.push_back({.time = instant(rows, i, 0),
                       .who = std::string{rows.text(i, 1)},
                       .action = std::string{rows.text(i, 2)},
                       .subject = std::string{rows.text(i, 3)},
                       .text = std::string{rows.text(i, 4)},
                       .role = std::string{rows.text(i, 5)}});
  }
  return entries;
}

}  // namespace recald::record
