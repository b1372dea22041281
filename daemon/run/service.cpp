#include "daemon/run/service.hpp"

#include <utility>  // Boost 1.74's Asio uses std::exchange without it

#include <spdlog/sinks/stdout_sinks.h>
#include <spdlog/spdlog.h>

#include <boost/asio/awaitable.hpp>
#include <boost/asio/co_spawn.hpp>
#include <boost/asio/detached.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/signal_set.hpp>
#include <boost/asio/use_awaitable.hpp>
#include <csignal>
#include <random>

#include "adapters/asio/asio_loop.hpp"
#include "adapters/modbus/bus_thread.hpp"
#include "adapters/sqlite/sqlite_store.hpp"
#include "adapters/system/file_lock.hpp"
#include "adapters/system/time_zone_release.hpp"
#include "daemon/run/gateway.hpp"

namespace recald::daemon {
namespace {

/// Ends the loop at the first signal that asks for it.
boost::asio::awaitable<void> wait_for_end(boost::asio::io_context& context) {
  boost::asio::signal_set signals{context, SIGINT, SIGTERM};
  const int signal = co_await signals.async_wait(boost::asio::use_awaitable);
  spdlog::info("event=ending signal={}", signal);
  context.stop();
}

void log_month(const metering::Meter& meter, const metering::MonthlyFigure& figure) {
  spdlog::info(
      "event=month_closed meter={} month={} revision={} kWh_per_day={:.1f} coverage={:.3f}",
      meter.id, metering::to_string(figure.month), figure.revision, figure.daily_average_kWh,
      figure.coverage);
}

}  // namespace

Result<void> run_service(const SiteConfig& site, const metering::LocalCalendar& calendar) {
  spdlog::set_default_logger(spdlog::stderr_logger_st("recald"));
  spdlog::set_pattern("%Y-%m-%dT%H:%M:%S.%eZ %l %v", spdlog::pattern_time_type::utc);
  const auto lock = system::FileLock::take(site.store.file.string() + ".lock");
  if (!lock) return tl::unexpected(lock.error());
  auto store = sqlite::SqliteStore::open(site.store.file);
  if (!store) return tl::unexpected(store.error());

  boost::asio::io_context context{1};
  asio::AsioLoop loop{context};
  auto gateway =
      Gateway::open(site, calendar,
                    {.loop = loop,
                     .store = *store,
                     .make_bus =
                         [&](const BusConfig& bus) {
                           return std::make_unique<modbus::BusThread>(bus.endpoint, loop);
                         },
                     .time_zone_release = system::time_zone_release(),
                     .seed = std::random_device{}()},  // for jitter only: no result depends on it
                    log_month);
  if (!gateway) return tl::unexpected(gateway.error());
  boost::asio::co_spawn(context, wait_for_end(context), boost::asio::detached);
  spdlog::info("event=started site={} store={}", site.id, site.store.file.string());
  (*gateway)->start();
  context.run();
  const auto flushed = (*gateway)->flush();
  gateway->reset();  // its bus threads end before the loop that they post to
  spdlog::info("event=ended");
  return flushed;
}

}  // namespace recald::daemon
