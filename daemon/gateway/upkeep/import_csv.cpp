#include "daemon/gateway/upkeep/import_csv.hpp"

#include <algorithm>
#include <cmath>
#include <set>
#include <span>
#include <utility>

#include "adapters/system/files/regular_file.hpp"
#include "adapters/system/files/sha256.hpp"
#include "adapters/system/time_zone_release.hpp"

namespace recald::daemon {
namespace {

using metering::Month;
using metering::Reading;

constexpr std::size_t kBatchMax = 1000;

/// One import, within a transaction.
class Import {
 public:
  Import(Store& store, const SiteConfig& site, const metering::LocalCalendar& calendar,
         const ImportOptions& options)
      : store_(store), site_(site), calendar_(calendar), options_(options) {}

  [[nodiscard]] Result<ImportOutcome> run(const std::filesystem::path& file,
                                          metering::Instant now) {
    TRY(begin(file, now));
    auto report = TRY(csv::read_readings(
        file, file_options(), {.on_meter = {}, .on_reading = [&](const Reading& r) { take(r); }}));
    for (std::size_t i = 0; i < meters_.size(); ++i) commit(i);
    if (!failed_) return tl::unexpected(failed_.error());
    outcome_.file = std::move(report);
    if (outcome_.taken == 0) {
      TRY(store_.remove_edit(edit_));
    }
    MonthKeeper keeper{store_, calendar_, site_.closing, system::time_zone_release()};
    std::vector<StoredMeter> stored;
    for (const MeterImport& meter : meters_) stored.push_back(meter.stored);
    const auto until = TRY(known_until(stored));
    outcome_.closed = TRY(keeper.close_due(stored, std::min(now, until)));
    return std::move(outcome_);
  }

 private:
  struct MeterImport {
    StoredMeter stored;
    std::set<Month> closed;
    StoreBatch batch;  ///< For one month.
    Month month{};
  };

  Result<void> begin(const std::filesystem::path& file, metering::Instant now) {
    if (auto is_file = system::require_file(file, "readings file"); !is_file) return is_file;
    system::Sha256 hash;
    if (auto added = hash.add_file(file); !added) return added;
    edit_ = TRY(store_.add_edit({.time = now,
                                 .author = options_.author,
                                 .reason = options_.reason,
                                 .file = file.filename().string(),
                                 .sha256 = hash.hex()}));
    for (const MeterConfig& config : site_.meters) {
      if (config.source == MeterSource::sum) continue;  // has no readings of its own
      const auto number = TRY(store_.meter_number(config.meter.id, config.meter.interval));
      const auto months = TRY(store_.months(number));
      MeterImport meter{.stored = {number, config.meter}};
      for (const StoredMonth& month : months) meter.closed.insert(month.figure.month);
      meters_.push_back(std::move(meter));
    }
    return {};
  }

  /// The time up to which the stored months are due. A file does not cover the time after its end:
  /// readings that have not been made yet are not missing.
  [[nodiscard]] Result<metering::Instant> known_until(std::span<const StoredMeter> meters) const {
    metering::Instant last{};
    for (const StoredMeter& meter : meters) {
      const auto extent = TRY(store_.interval_extent(meter.number));
      if (extent) last = std::max(last, extent->end + meter.meter.interval);
    }
    return last + site_.closing.watermark;
  }

  [[nodiscard]] csv::ReadingsOptions file_options() const {
    csv::ReadingsOptions options;
    for (const MeterConfig& config : site_.meters) {
      if (config.source == MeterSource::sum) continue;  // has no readings of its own
      options.meters.push_back({.name = config.meter.id,
                                .utility = config.meter.utility,
                                .stamps = options_.stamps,
                                .interval = config.meter.interval,
                                .units = config.units});
    }
    return options;
  }

  void take(Reading reading) {
    MeterImport& meter = meters_[reading.meter];
    const Month month = calendar_.month_of(reading.start);
    if (month != meter.month || meter.batch.intervals.size() >= kBatchMax) commit(reading.meter);
    meter.month = month;
    reading.meter = meter.stored.number;
    if (std::isnan(reading.mean_kW)) reading.validity = metering::Validity::missing;
    reading.late |= meter.closed.contains(month);
    meter.batch.intervals.push_back({reading, options_.supersedes});
  }

  /// The first failure ends the import.
  void commit(std::size_t index) {
    MeterImport& meter = meters_[index];
    StoreBatch batch = std::exchange(meter.batch, {});
    if (batch.intervals.empty() || !failed_) return;
    batch.edit = edit_;
    const auto counts = store_.commit(batch);
    if (!counts) {
      failed_ = tl::unexpected(counts.error());
      return;
    }
    outcome_.taken += static_cast<std::uint64_t>(counts->taken);
    outcome_.duplicates += static_cast<std::uint64_t>(counts->duplicates);
    outcome_.weaker += static_cast<std::uint64_t>(counts->weaker);
    outcome_.conflicts += counts->conflicts.size();
    if (counts->taken > 0) reopen(meter, batch);
  }

  void reopen(const MeterImport& meter, const StoreBatch& batch) {
    StoreBatch changes;
    const auto earliest = std::ranges::min(batch.intervals, {}, [](const auto& interval) {
                            return interval.reading.start;
                          }).reading.start;
    for (const Month month : months_that_depend_on(earliest, calendar_)) {
      if (!meter.closed.contains(month)) continue;
      const MeterMonth changed{meter.stored.number, month};
      if (std::ranges::find(outcome_.reopened, changed) != outcome_.reopened.end()) continue;
      outcome_.reopened.push_back(changed);
      changes.reopened.push_back(changed);
    }
    if (changes.empty()) return;
    if (const auto put = store_.commit(changes); !put) failed_ = tl::unexpected(put.error());
  }

  Store& store_;
  const SiteConfig& site_;
  const metering::LocalCalendar& calendar_;
  const ImportOptions& options_;
  std::int64_t edit_ = 0;
  std::vector<MeterImport> meters_;  ///< By meter of the site, without sums.
  Result<void> failed_;
  ImportOutcome outcome_;
};

}  // namespace

Result<ImportOutcome> import_readings(Store& store, const SiteConfig& site,
                                      const metering::LocalCalendar& calendar,
                                      const std::filesystem::path& file,
                                      const ImportOptions& options, metering::Instant now) {
  std::optional<ImportOutcome> outcome;
  const auto kept = store.as_one([&]() -> Result<void> {
    outcome = TRY(Import{store, site, calendar, options}.run(file, now));
    if (options.dry_run) return failure(ErrorCode::cancelled, "a rehearsal is undone");
    return {};
  });
  if (!kept && !(outcome && options.dry_run)) return tl::unexpected(kept.error());
  return std::move(*outcome);
}

}  // namespace recald::daemon
