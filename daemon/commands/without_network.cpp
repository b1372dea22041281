/// The commands that talk to meters, brokers, databases or a running daemon, in a program without
/// them: the one that daemon/demo.sh builds.
#include "daemon/commands/commands.hpp"

namespace recald::daemon {
namespace {

int not_here(const Console& console) {
  return console.fail(
      "this recald was built for the demo, without what talks to meters and servers; build the "
      "whole with "
      "cmake --preset release && cmake --build --preset release --target recald");
}

}  // namespace

int run_check(const CheckArguments&, const Console& console) { return not_here(console); }
int run_decode(const DecodeArguments&, const Console& console) { return not_here(console); }
int run_doctor(const SiteArguments&, const Console& console) { return not_here(console); }
int run_export(const ExportArguments&, const Console& console) { return not_here(console); }
int run_fleet_add(const FleetAddArguments&, const Console& console) { return not_here(console); }
int run_fleet_init(const FleetArguments&, const Console& console) { return not_here(console); }
int run_fleet_priors(const FleetPriorsArguments&, const Console& console) {
  return not_here(console);
}
int run_fleet_remove(const FleetAddArguments&, const Console& console) { return not_here(console); }
int run_fleet_rerun(const FleetRerunArguments&, const Console& console) {
  return not_here(console);
}
int run_fleet_serve(const FleetArguments&, const Console& console) { return not_here(console); }
int run_fleet_status(const FleetArguments&, const Console& console) { return not_here(console); }
int run_import(const ImportArguments&, const Console& console) { return not_here(console); }
int run_registers(const RegistersArguments&, const Console& console) { return not_here(console); }
int run_restore(const RestoreArguments&, const Console& console) { return not_here(console); }
int run_run(const RunArguments&, const Console& console) { return not_here(console); }
int run_scan(const ScanArguments&, const Console& console) { return not_here(console); }
int run_status(const StatusArguments&, const Console& console) { return not_here(console); }
int run_verify(const SiteArguments&, const Console& console) { return not_here(console); }
int run_worker(const WorkerArguments&, const Console& console) { return not_here(console); }

}  // namespace recald::daemon
