#include <nlohmann/json.hpp>

#include "daemon/commands/commands.hpp"
#include "daemon/gateway/registers/register_page.hpp"

namespace recald::daemon {

int run_registers(const RegistersArguments& arguments, const Console& console) {
  if (arguments.site.empty()) {
    console.out << register_page();
    return kSuccess;
  }
  const auto site = load_site(arguments.site);
  if (!site) return console.fail(site.error());
  if (arguments.json) {
    console.out << registers_json(*site).dump(2) << "\n";
  } else {
    console.out << (arguments.csv ? registers_csv(*site) : registers_text(*site));
  }
  return kSuccess;
}

}  // namespace recald::daemon
