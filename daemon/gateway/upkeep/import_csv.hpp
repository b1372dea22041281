/// Readings put in by hand: a CSV file with a reason, kept as an edit.
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
  bool supersedes = false;  ///< Takes the place of good readings too.
  bool dry_run = false;     ///< Says what would happen; the store stays as it is.
};

struct ImportOutcome {
  csv::ReadingsReport file;
  std::uint64_t taken = 0;
  std::uint64_t duplicates = 0;  ///< Said what the store knew.
  std::uint64_t weaker = 0;      ///< The store knew better.
  std::uint64_t conflicts = 0;   ///< As good, with another value; the store's stayed.
  std::vector<MeterMonth> reopened;
  std::vector<ClosedFigure> closed;  ///< Months that were due, or changed.
};

/// Imports a file in one transaction: all of its good lines, or nothing. What is known already
/// changes nothing, so a file may come twice; one of which nothing was taken leaves no edit.
///
/// Values stand as they are: `multiplier`, `stamps`, `counter` and `name_in_file` of a meter
/// describe its own source. Every meter of the site may have a history, live ones too; each is
/// taken at the interval of the site file. Closed months that the readings change are closed again.
///
/// @pre  nobody else writes to the store.
/// @return or as csv::read_readings, or the store's failure.
[[nodiscard]] Result<ImportOutcome> import_readings(Store& store, const SiteConfig& site,
                                                    const metering::LocalCalendar& calendar,
                                                    const std::filesystem::path& file,
                                                    const ImportOptions& options,
                                                    metering::Instant now);

}  // namespace recald::daemon
