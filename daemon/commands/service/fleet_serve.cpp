#include <utility>  // Boost 1.74's Asio uses std::exchange without it

#include <fmt/format.h>

#include <boost/asio/executor_work_guard.hpp>
#include <boost/asio/io_context.hpp>
#include <chrono>

#include "adapters/record/schema.hpp"
#include "daemon/commands/commands.hpp"
#include "daemon/commands/interrupt.hpp"
#include "daemon/fleet/config/fleet_config.hpp"
#include "daemon/fleet/config/open_record.hpp"
#include "daemon/fleet/serve/fleet_pages.hpp"
#include "daemon/gateway/serve/site_server.hpp"

namespace recald::daemon {

int run_fleet_serve(const FleetArguments& arguments, const Console& console) {
  const auto config = load_fleet(arguments.fleet);
  if (!config) return console.fail(config.error());
  const auto options = server_options(config->http.value_or(HttpConfig{}));
  if (!options) return console.fail(options.error());
  const auto record = open_record(config->record);
  if (!record) return console.fail(record.error());
  if (auto checked = record::check_schema(**record); !checked) return console.fail(checked.error());
  const FleetServed served{
      .record = **record,
      .now =
          [] { return std::chrono::floor<std::chrono::seconds>(std::chrono::system_clock::now()); },
      .who = "page"};
  boost::asio::io_context context;
  const auto server = http::Server::listen(
      context, *options,
      [&served](const http::Request& request) { return answer_fleet(served, request); });
  if (!server) return console.fail(server.error());
  console.err << fmt::format("listening on {}:{}\n", options->address, (*server)->port());
  const InterruptGuard guard;
  const auto work = boost::asio::make_work_guard(context);
  while (!guard.interrupted()) context.run_for(std::chrono::milliseconds{100});
  return kSuccess;
}

}  // namespace recald::daemon
