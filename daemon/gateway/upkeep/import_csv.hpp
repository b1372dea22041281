/// Manual imports: a CSV file of readings with a reason, recorded as an edit.
#pragma once

#include <filesystem>
#include <string>

#include "adapters/csv/readings_csv.hpp"
#include "adapters/ports/store.hpp"
#include "daemon/gateway/ingest/month_keeper.hpp"
#include "daemon/site/config/site_config.hpp"

namespace recald::daemon {

struct ImportOptions {
  std::string author;
  std::string reason;  ///< Not empty.
  csv::Stamps stamps = csv::Stamps::start;
  bool supersedes = false;  ///< Replaces good readings too.
  bool dry_run = false;     ///< Reports what would happen and does not change the store.
};

struct ImportOutcome {
  csv::ReadingsReport file;
  std::uint64_t taken = 0;
  std::uint64_t duplicates = 0;  ///< Equal to the stored ones.
  std::uint64_t weaker = 0;      ///< Worse than the stored ones.
  std::uint64_t conflicts = 0;   ///< Equally good, but another value; the stored one stays.
  std::vector<MeterMonth> reopened;
  std::vector<ClosedFigure> closed;  ///< Months that were due or have changed.
};

/// Imports a file in one transaction: all of its good lines, or nothing. Readings that are
/// already stored change nothing, so a file may be imported twice; an import that adds
/// nothing leaves no edit.
///
/// Values are used unchanged: `multiplier`, `stamps`, `counter` and `name_in_file` of a meter
/// describe its own source. Every meter of the site may have a history, including live ones; each
/// uses the interval of the site file. Closed months that the readings change are closed again.
///
/// @pre  nobody else writes to the store.
/// @return the outcome, or as csv::read_readings, or the store's failure.
[[nodiscard]] Result<ImportOutcome> import_readings(Store& store, const SiteConfig& site,
                                                    const metering::LocalCalendar& calendar,
                                                    const std::filesystem::path& file,
                                                    const ImportOptions& options,
                                                    metering::Instant now);

}  // namespace recald::daemon
