/// What the program that daemon/demo.sh builds leaves out, in its place: commands that the demo
/// does not come to, and stores.
#include "adapters/stores/open.hpp"
#include "daemon/commands/commands.hpp"

namespace recald::daemon {
namespace {

constexpr const char* kWhy =
    "this recald was built for the demo and has only what that needs; build the whole with "
    "cmake --preset release && cmake --build --preset release --target recald";

int not_here(const Console& console) { return console.fail(kWhy); }

}  // namespace

int run_calibrate_design(const CalibrateArguments&, const Console& console) {
  return not_here(console);
}
int run_check(const CheckArguments&, const Console& console) { return not_here(console); }
int run_decode(const DecodeArguments&, const Console& console) { return not_here(console); }
int run_detectability(const DetectabilityArguments&, const Console& console) {
  return not_here(console);
}
int run_doctor(const SiteArguments&, const Console& console) { return not_here(console); }
int run_doe(const DoeArguments&, const Console& console) { return not_here(console); }
int run_drift(const DriftArguments&, const Console& console) { return not_here(console); }
int run_ecm(const EcmArguments&, const Console& console) { return not_here(console); }
int run_engine_show(const EngineArguments&, const Console& console) { return not_here(console); }
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
int run_init(const InitArguments&, const Console& console) { return not_here(console); }
int run_metamodel(const MetamodelArguments&, const Console& console) { return not_here(console); }
int run_model_apply(const ModelArguments&, const Console& console) { return not_here(console); }
int run_model_list(const ModelArguments&, const Console& console) { return not_here(console); }
int run_model_revert(const ModelArguments&, const Console& console) { return not_here(console); }
int run_model_show(const ModelArguments&, const Console& console) { return not_here(console); }
int run_profile(const ProfileArguments&, const Console& console) { return not_here(console); }
int run_registers(const RegistersArguments&, const Console& console) { return not_here(console); }
int run_replay_recording(const ReplayArguments&, const Console& console) {
  return not_here(console);
}
int run_report(const ReportArguments&, const Console& console) { return not_here(console); }
int run_restore(const RestoreArguments&, const Console& console) { return not_here(console); }
int run_run(const RunArguments&, const Console& console) { return not_here(console); }
int run_scan(const ScanArguments&, const Console& console) { return not_here(console); }
int run_screen(const ScreenArguments&, const Console& console) { return not_here(console); }
int run_status(const StatusArguments&, const Console& console) { return not_here(console); }
int run_verify(const SiteArguments&, const Console& console) { return not_here(console); }
int run_worker(const WorkerArguments&, const Console& console) { return not_here(console); }

}  // namespace recald::daemon

namespace recald::stores {

Result<std::unique_ptr<Store>> open_to_read(const std::filesystem::path&) {
  return failure(ErrorCode::unsupported, daemon::kWhy);
}

}  // namespace recald::stores
