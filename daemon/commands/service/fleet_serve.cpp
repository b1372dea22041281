#include <utility>  // Boost 1.74's Asio uses std::exchange without it

#include <fmt/format.h>

#include <boost/asio/executor_work_guard.hpp>
#include <boost/asio/io_context.hpp>
#include <chrono>
#include <stop_token>

#include "adapters/asio/asio_loop.hpp"
#include "adapters/record/schema.hpp"
#include "adapters/system/worker_thread.hpp"
#include "daemon/commands/commands.hpp"
#include "daemon/commands/interrupt.hpp"
#include "daemon/fleet/config/fleet_config.hpp"
#include "daemon/fleet/config/open_record.hpp"
#include "daemon/fleet/serve/fleet_pages.hpp"
#include "daemon/gateway/serve/site_server.hpp"

namespace recald::daemon {
namespace {

constexpr std::chrono::seconds kAnswerMax{10};  // of the database, for a page

}  // namespace

int run_fleet_serve(const FleetArguments& arguments, const Console& console) {
  const auto config = load_fleet(arguments.fleet);
  if (!config) return console.fail(config.error());
  auto options = server_options(config->http.value_or(HttpConfig{}));
  if (!options) return console.fail(options.error());
  std::stop_source stop;
  const auto record =
      open_record(config->record, {.answer_max = kAnswerMax, .stop = stop.get_token()});
  if (!record) return console.fail(record.error());
  if (auto checked = record::check_schema(**record); !checked) return console.fail(checked.error());
  const FleetServed served{
      .record = **record,
      .now =
          [] { return std::chrono::floor<std::chrono::seconds>(std::chrono::system_clock::now()); },
      .who = "page"};
  const InterruptGuard guard;
  boost::asio::io_context context;
  asio::AsioLoop loop{context};
  // Whatever the database does, the loop answers probes and signals.
  system::WorkerThread worker{loop};
  options->prompt_paths = {"/healthz"};
  options->worker = &worker;
  const auto server = http::Server::listen(
      context, *options,
      [&served](const http::Request& request) { return answer_fleet(served, request); });
  if (!server) return console.fail(server.error());
  console.err << fmt::format("listening on {}:{}\n", options->address, (*server)->port());
  const auto work = boost::asio::make_work_guard(context);
  while (!guard.interrupted()) context.run_for(std::chrono::milliseconds{100});
  stop.request_stop();
  return kSuccess;
}

}  // namespace recald::daemon
