/// A gateway on a virtual clock with meters whose energy is known at any instant: for all tests of
/// what a gateway does, serves or leaves in its store.
#pragma once

#include <fmt/format.h>

#include <cmath>
#include <map>
#include <memory>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "adapters/sqlite/sqlite_store.hpp"
#include "daemon/gateway/run/gateway.hpp"
#include "tests/support/counter_bus.hpp"
#include "tests/support/failing_store.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/support/virtual_loop.hpp"

namespace recald::daemon::testing {

inline const metering::Instant kRigStart = std::chrono::sys_days{std::chrono::year{2024} / 2 / 28};

inline double hours_of(std::chrono::milliseconds t) {
  return static_cast<double>(t.count()) / 3.6e6;
}

/// 60 kW with a daily course of 30 kW, and 100 kW all day.
inline double main_kWh(std::chrono::milliseconds t) {
  const double h = hours_of(t);
  return 5000.0 + 60.0 * h + 30.0 * 24.0 / 6.283185307 * (1.0 - std::cos(h / 24.0 * 6.283185307));
}
inline double cooling_kWh(std::chrono::milliseconds t) { return 100.0 * hours_of(t); }

/// Parts of a site file. @param more  Of its [site].
inline std::string site_head(const std::string& zone, const std::string& more = "") {
  return "[site]\nid = \"tower\"\ntimezone = \"" + zone + "\"\n" + more;
}
inline constexpr const char* kMainMeter = R"(
[bus.plant]
type = "tcp"
host = "unused"

[[meter]]
id = "main"
source = "modbus"
utility = "electricity"
bus = "plant"
unit = 1
map = "counter.toml"
rated_kW = 400
poll = "60s"
)";
inline constexpr const char* kCoolingMeter = R"(
[[meter]]
id = "cooling"
source = "modbus"
utility = "chilled_water"
bus = "plant"
unit = 2
map = "counter.toml"
rated_kW = 900
poll = "60s"
)";

/// Both meters in Chicago. @param more  Of its [site].
inline std::string two_meter_site(const std::string& more = "") {
  return site_head("America/Chicago", more) + kMainMeter + kCoolingMeter;
}

/// Writes a site file, and the register map of its meters where none stands, and loads it.
inline SiteConfig load_rig_site(const std::filesystem::path& folder, const std::string& text) {
  if (!std::filesystem::exists(folder / "counter.toml")) {
    recald::testing::write_text(folder / "counter.toml", recald::testing::CounterBus::kMap);
  }
  recald::testing::write_text(folder / "site.toml", text);
  auto loaded = load_site(folder / "site.toml");
  if (!loaded) throw std::runtime_error(loaded.error().front());
  return std::move(*loaded);
}

/// Energy of a meter's intervals in a span, those without a value left out.
inline double stored_kWh(Store& store, std::uint32_t meter, const metering::TimeSpan& span) {
  double sum_kWh = 0.0;
  (void)store.for_each_interval(meter, span, [&](const StoredInterval& interval) {
    if (!std::isnan(interval.reading.mean_kW)) sum_kWh += interval.reading.mean_kW * 0.25;
  });
  return sum_kWh;
}

/// Whether both meters' intervals add up to what was counted between the first and the last of
/// them.
/// @return what is wrong; empty: nothing.
inline std::string what_energy_is_wrong(Store& store) {
  constexpr double kTick_kWh = 0.1 + 1e-6;  // two registers of 0.1 kWh bound an energy
  for (std::uint32_t meter = 0; meter < 2; ++meter) {
    const auto extent = store.interval_extent(meter);
    if (!extent) return extent.error().message;
    if (!*extent) continue;
    const metering::TimeSpan span{(*extent)->begin, (*extent)->end + std::chrono::seconds{900}};
    const auto counted_kWh = [&](metering::Instant t) {
      return meter == 0 ? main_kWh(t - kRigStart) : cooling_kWh(t - kRigStart);
    };
    const double off_kWh =
        stored_kWh(store, meter, span) - (counted_kWh(span.end) - counted_kWh(span.begin));
    if (std::abs(off_kWh) <= kTick_kWh) continue;
    return fmt::format("meter {}: {:.3f} kWh too much until {}", meter, off_kWh,
                       metering::to_string(span.end));
  }
  return "";
}

/// Begins, ends and begins again on one store and one clock, as processes do.
class GatewayRig {
 public:
  /// @param began  When the meters, units 1 and 2, had counted nothing yet; they know no clock.
  GatewayRig(Store& store, recald::testing::VirtualLoop& loop, metering::Instant began)
      : kept_in_(store), runs_on_(loop) {
    const Moment now = loop.now();
    const auto before = std::chrono::floor<std::chrono::milliseconds>(now.wall - began);
    const auto at_zero = before - now.monotonic;
    devices_[1].energy_kWh = [=](auto t) { return main_kWh(at_zero + t); };
    devices_[2].energy_kWh = [=](auto t) { return cooling_kWh(at_zero + t); };
  }

  /// Ends the gateway, if one runs, and begins another.
  [[nodiscard]] Result<void> open(const SiteConfig& site) {
    gateway_.reset();
    auto opened = Gateway::open(
        site, metering::LocalCalendar::open(site.timezone).value(),
        {.loop = runs_on_,
         .store = kept_in_,
         .make_bus =
             [this](const BusConfig& bus) {
               buses_made_.push_back(bus.name);
               return std::make_unique<recald::testing::CounterBus>(runs_on_, devices_);
             },
         .time_zone_release = "2025b",
         .clock = clock_,
         .recorder = recorder_},
        [this](const metering::Meter& meter, const metering::MonthlyFigure& figure) {
          closed_.push_back({meter.id, figure, runs_on_.now().instant()});
        });
    if (!opened) return tl::unexpected(opened.error());
    gateway_ = std::move(*opened);
    if (before_start_) before_start_();
    gateway_->start();
    return {};
  }
  Result<void> reload(const SiteConfig& site) { return gateway_->reload(site); }
  void begin(const SiteConfig& site) {
    if (const auto opened = open(site); !opened) throw std::runtime_error(opened.error().message);
  }

 protected:
  struct ClosedMonth {
    std::string meter;
    metering::MonthlyFigure figure;
    metering::Instant at;
  };

  std::map<std::uint8_t, recald::testing::CounterDevice> devices_;  ///< By unit; of every bus.
  std::optional<ClockEvidence> clock_ =
      ClockEvidence{.released = std::chrono::sys_days{std::chrono::year{2024} / 1 / 1}};
  recording::Listener* recorder_ = nullptr;
  std::function<void()> before_start_;   ///< Of each gateway, when it is open.
  std::vector<std::string> buses_made_;  ///< Their names.
  std::vector<ClosedMonth> closed_;      ///< In order, all revisions.
  std::unique_ptr<Gateway> gateway_;

 private:
  Store& kept_in_;
  recald::testing::VirtualLoop& runs_on_;
};

/// What a gateway needs around it: a folder for its site file, a store in memory that refuses when
/// it is told to, a clock.
struct RigSurroundings {
  explicit RigSurroundings(metering::Instant start) : loop_{start} {}

  recald::testing::TemporaryFolder folder_;
  sqlite::SqliteStore disk_ = sqlite::SqliteStore::open(":memory:").value();
  recald::testing::FailingStore store_{disk_};
  recald::testing::VirtualLoop loop_;
};

/// A rig with all that it needs; its meters begin with it.
class RigInMemory : protected RigSurroundings, protected GatewayRig {
 protected:
  explicit RigInMemory(metering::Instant start)
      : RigSurroundings{start}, GatewayRig{store_, loop_, start} {}

  SiteConfig load(const std::string& text) { return load_rig_site(folder_.path(), text); }

  /// What holds of a meter's intervals that start in a span.
  std::vector<metering::Reading> stored(const std::string& id, const metering::TimeSpan& span) {
    std::vector<metering::Reading> readings;
    const auto read = disk_.for_each_interval(
        disk_.find_meter(id).value().value(), span,
        [&](const StoredInterval& interval) { readings.push_back(interval.reading); });
    if (!read) throw std::runtime_error(read.error().message);
    return readings;
  }
  double stored_kWh(const std::string& id, const metering::TimeSpan& span) {
    return testing::stored_kWh(disk_, disk_.find_meter(id).value().value(), span);
  }
};

}  // namespace recald::daemon::testing
