#include "daemon/site/replay/stored_readings.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <utility>

#include "adapters/stores/open.hpp"
#include "adapters/system/files/sha256.hpp"
#include "core/absent.hpp"
#include "core/metering/months/closing_rules.hpp"

namespace recald::daemon {
namespace {

/// Adds the bytes of a reading that results depend on. All missing values get the same NaN.
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
  std::unique_ptr<Store> store;
  metering::ClosingOptions closing;
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
  auto store = TRY(stores::open_to_read(site.store.file));
  return std::unique_ptr<StoredReadings>{
      new StoredReadings{std::unique_ptr<Impl>{new Impl{std::move(store), site.closing.closing}}}};
}

Result<std::vector<metering::MonthlyFigure>> StoredReadings::months(const MeterConfig& meter) {
  const auto number = TRY(impl_->store->find_meter(meter.meter.id));
  if (!number) return std::vector<metering::MonthlyFigure>{};
  auto stored = TRY(impl_->store->months(*number));
  impl_->digest.add(meter.meter.id);
  std::vector<metering::MonthlyFigure> figures;
  for (StoredMonth& month : stored) {
    const metering::MonthlyFigure& figure = month.figure;
    impl_->digest.add(fmt::format("{} {} {}", metering::to_string(figure.month), figure.revision,
                                  figure.daily_average_kWh));
    figures.push_back(std::move(month.figure));
  }
  return figures;
}

Result<int> StoredReadings::waiting_months(const MeterConfig& meter) {
  const auto number = TRY(impl_->store->find_meter(meter.meter.id));
  if (!number) return 0;
  const auto rules = TRY(impl_->store->closing_rules(*number));
  if (rules != metering::closing_rules(impl_->closing, meter.meter)) {
    const auto all = TRY(impl_->store->months(*number));
    return static_cast<int>(all.size());
  }
  const auto reopened = TRY(impl_->store->reopened());
  return static_cast<int>(std::ranges::count(reopened, *number, &MeterMonth::meter));
}

Result<std::uint64_t> StoredReadings::for_each(const MeterConfig& meter,
                                               const metering::TimeSpan& span,
                                               const ReadingSink& sink) {
  const auto number = TRY(impl_->store->find_meter(meter.meter.id));
  if (!number) return std::uint64_t{0};
  impl_->digest.add(meter.meter.id);
  std::uint64_t count = 0;
  TRY(impl_->store->for_each_interval(*number, span, [&](const StoredInterval& stored) {
    add_to(impl_->digest, stored.reading);
    sink(stored.reading);
    ++count;
  }));
  return count;
}

Result<std::optional<metering::Instant>> StoredReadings::first_start(const MeterConfig& meter) {
  const auto number = TRY(impl_->store->find_meter(meter.meter.id));
  if (!number) return std::optional<metering::Instant>{};
  const auto extent = TRY(impl_->store->interval_extent(*number));
  if (!extent) return std::optional<metering::Instant>{};
  impl_->digest.add(meter.meter.id);
  impl_->digest.add(metering::to_string(extent->begin));
  return std::optional{extent->begin};
}

std::string StoredReadings::digest() { return impl_->digest.hex(); }

Result<std::unique_ptr<StoredReadings>> open_sensors(const SiteConfig& site) {
  std::error_code ignored;
  if (site.sensors.empty() || !std::filesystem::exists(site.store.file, ignored)) return nullptr;
  return StoredReadings::open(site);
}

}  // namespace recald::daemon
