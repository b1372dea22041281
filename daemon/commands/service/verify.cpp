#include "daemon/gateway/upkeep/verify.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "daemon/commands/commands.hpp"
#include "daemon/commands/open_site.hpp"
#include "daemon/gateway/upkeep/stored_site.hpp"

namespace recald::daemon {

int run_verify(const SiteArguments& arguments, const Console& console) {
  const auto site = open_site(arguments.site);
  if (!site) return console.fail(site.error());
  auto store = open_to_read(site->config);
  if (!store && store.error().code == ErrorCode::malformed) {
    return console.fail(damaged_file(store.error().message));
  }
  if (!store) return console.fail(store.error());
  const auto verified = verify_store(**store, site->config, site->calendar);
  if (!verified) return console.fail(verified.error());
  if (arguments.json) {
    const nlohmann::ordered_json json{{"sound", verified->problems.empty()},
                                      {"intervals", verified->intervals},
                                      {"days_compared", verified->days_compared},
                                      {"months_compared", verified->months_compared},
                                      {"problems", verified->problems}};
    console.out << json.dump(2) << "\n";
  }
  if (!verified->problems.empty()) return console.fail(verified->problems);
  if (!arguments.json) {
    console.out << fmt::format(
        "the store is sound: {} intervals; {} days agree with their counters, {} months with their "
        "readings\n",
        verified->intervals, verified->days_compared, verified->months_compared);
  }
  return kSuccess;
}

}  // namespace recald::daemon
