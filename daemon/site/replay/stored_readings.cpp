#include "daemon/site/replay/stored_readings.hpp"

#include <fmt/format.h>

#include <cmath>
#include <cstring>
#include <utility>

#include "adapters/sqlite/sqlite_store.hpp"
#include "adapters/system/sha256.hpp"
#include "core/absent.hpp"

namespace recald::daemon {
namespace {

/// The bytes of a reading that results depend on. A missing value has one NaN, not any.
void add_to(system::Sha256& digest, const metering::Reading& reading) {
  struct Bytes {
    std::int64_t start;
    double mean_kW;
    std::uint32_t validity;
    std::uint32_t reasons;
  };
  const Bytes bytes{reading.start.time_since_epoch().count(),
                    std::isnan(reading.mean_kW) ? kAbsent : reading.mean_kW,
                    static_cast<std::uint32_t>(reading.validity),
                    static_cast<std::uint32_t>(reading.reasons)};
  static_assert(sizeof(Bytes) == 24, "no padding: it would have any value");
  char text[sizeof(Bytes)];
  std::memcpy(text, &bytes, sizeof(Bytes));
  digest.add({text, sizeof(Bytes)});
}

}  // namespace

struct StoredReadings::Impl {
  sqlite::SqliteStore store;
  system::Sha256 digest{};
};

StoredReadings::StoredReadings(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
StoredReadings::~StoredReadings() = default;

Result<std::unique_ptr<StoredReadings>> StoredReadings::open(const SiteConfig& site) {
  if (std::error_code ignored; !std::filesystem::exists(site.store.file, ignored)) {
    return failure(ErrorCode::not_found,
                   fmt::format("the store {} does not exist yet; `recald run {}` fills it from the "
                               "meters, `recald import` from files",
                               site.store.file.string(), site.file.filename().string()));
  }
  auto store = sqlite::SqliteStore::open(
      site.store.file, {.access = sqlite::Database::Access::read_only, .vfs = {}});
  if (!store) return tl::unexpected(store.error());
  return std::unique_ptr<StoredReadings>{
      new StoredReadings{std::unique_ptr<Impl>{new Impl{std::move(*store)}}}};
}

Result<std::uint64_t> StoredReadings::for_each(const MeterConfig& meter, const ReadingSink& sink) {
  const auto number = impl_->store.find_meter(meter.meter.id);
  if (!number) return tl::unexpected(number.error());
  if (!*number) return std::uint64_t{0};
  impl_->digest.add(meter.meter.id);
  std::uint64_t count = 0;
  const auto read = impl_->store.for_each_interval(
      **number, {metering::Instant{}, metering::kLatestInstant}, [&](const StoredInterval& stored) {
        add_to(impl_->digest, stored.reading);
        sink(stored.reading);
        ++count;
      });
  if (!read) return tl::unexpected(read.error());
  return count;
}

std::string StoredReadings::digest() { return impl_->digest.hex(); }

}  // namespace recald::daemon
