/// The sites of a fleet and what an operator has done, in the record.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "adapters/postgres/connection.hpp"
#include "core/metering/civil_time.hpp"
#include "core/result.hpp"

namespace recald::record {

/// A site as an operator gives it: its file and all files that it names.
struct SiteDescription {
  std::string id;
  std::string name;     ///< Of the site file; may be empty.
  std::string use;      ///< Of its [building]; empty: not said. For comparisons, as the next.
  std::string climate;  ///< As core/weather says it; empty: not known.
  std::optional<double> latitude_deg, longitude_deg;
  std::optional<double> floor_area_m2;
  std::string currency;
  std::vector<std::string> outputs;  ///< Ids of the meters whose months a calibration needs.
  /// Name relative to the site file's folder, which is first, to its bytes.
  std::string site_file;
  std::map<std::string, std::string> files;
  /// Months before it are not calibrated.
  metering::Month calibrate_from;
};

/// One version of a description; a change makes another.
struct SiteVersion {
  int number = 0;       ///< 1, 2, 3 …
  std::string sha256;   ///< Of the description and of names and bytes of all files.
  bool is_new = false;  ///< It was not there before.
};

struct RecordedSite {
  SiteDescription site;  ///< Without the bytes of its files.
  SiteVersion version;
  metering::Instant added;
  std::optional<metering::Instant> heard;   ///< When its gateway last sent something.
  std::optional<metering::Instant> newest;  ///< Start of its newest interval.
};

/// Registers a site, or a new version of it; a retired one is back. @param who  For the audit.
[[nodiscard]] Result<SiteVersion> put_site(postgres::Connection& connection,
                                           const SiteDescription& site, const std::string& who);

/// Its data stay; nothing is taken from it or calculated for it any more. @return not_found.
[[nodiscard]] Result<void> retire_site(postgres::Connection& connection, const std::string& site,
                                       const std::string& who);

/// In order of their ids, without retired ones.
[[nodiscard]] Result<std::vector<RecordedSite>> sites(postgres::Connection& connection);

/// With the bytes of its files. @return not_found.
[[nodiscard]] Result<SiteDescription> site_of_version(postgres::Connection& connection,
                                                      const std::string& site, int version);

struct AuditEntry {
  metering::Instant time;
  std::string who;  ///< As the program said that wrote it.
  std::string action, subject, text;
  std::string role;  ///< Of the database, which wrote it, as the server knows; empty: not known.
};

/// Newest first.
[[nodiscard]] Result<std::vector<AuditEntry>> audited(postgres::Connection& connection, int limit);

}  // namespace recald::record
