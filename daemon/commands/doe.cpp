#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "adapters/doe/folder_engine.hpp"
#include "adapters/system/parallel_for.hpp"
#include "core/display/warning.hpp"
#include "daemon/commands/commands.hpp"
#include "daemon/commands/interrupt.hpp"
#include "daemon/commands/open_site.hpp"
#include "daemon/site/calibrate/design_outliers.hpp"
#include "daemon/site/calibrate/design_site.hpp"
#include "daemon/site/calibrate/site_design.hpp"
#include "daemon/site/model/active_effects.hpp"

namespace recald::daemon {
namespace {

std::string design_json(const DoeArguments& arguments, const doe::DesignPlan& plan, int before,
                        const display::Warnings& warnings) {
  std::vector<std::string> parameters;
  for (const Parameter& parameter : plan.parameters) parameters.push_back(parameter.name);
  const nlohmann::ordered_json json = {{"folder", arguments.out.string()},
                                       {"runs", plan.theta.rows()},
                                       {"runs_before", before},
                                       {"parameters", parameters},
                                       {"outputs", plan.output_names},
                                       {"months", plan.months.size()},
                                       {"seed", plan.seed},
                                       {"warnings", display::texts_of(warnings)}};
  return json.dump(2) + "\n";
}

std::string design_words(const DoeArguments& arguments, const doe::DesignPlan& plan, int before,
                         const display::Warnings& warnings) {
  std::string text = fmt::format("{}: {} runs of {} parameters, {} outputs in {} months",
                                 arguments.out.string(), plan.theta.rows(), plan.parameters.size(),
                                 plan.output_names.size(), plan.months.size());
  text += before == 0 ? ".\n" : fmt::format("; {} of them already existed.\n", before);
  return text + display::warning_lines(warnings);
}

}  // namespace

int run_doe(const DoeArguments& arguments, const Console& console) {
  auto modelled = open_modelled_site(arguments.site, console, arguments.model);
  if (!modelled) return modelled.error();
  const auto& [site, recording, weather, facts] = *modelled;
  const auto version = active_version(site.config);
  if (!version) return console.fail(version.error());
  const auto prepared =
      prepare_site(site.config, site.calendar, recording, weather, version->effects);
  if (!prepared) return console.fail(prepared.error());
  const SiteDesignOptions options{
      .runs = arguments.runs,
      .seed = arguments.seed,
      .fingerprint = fmt::format("{} {} {}", version_name(*version, facts.model_version),
                                 facts.data_revision, facts.recald_version)};
  const doe::DesignPlan plan = plan_design(*prepared, options);

  const InterruptGuard guard;
  auto engine = site_engine(*prepared);
  auto folder = doe::FolderEngine::open(arguments.out, plan, &engine);
  if (!folder) return console.fail(folder.error());
  const int before = folder->done_count();
  const auto runs = [&] {
    ProgressLine line{console};
    return folder->run(plan.theta, system::parallel_for(arguments.threads),
                       [&](int done, int total) {
                         line.show({calibration::Progress::Stage::design, 0, done, total});
                         return !guard.interrupted();
                       });
  }();
  if (!runs) return console.fail(runs.error());
  if (auto noted = note_site(arguments.out, arguments.site, version->effects); !noted) {
    return console.fail(noted.error());
  }
  display::Warnings warnings = prepared->so_far.warnings;
  if (auto design = doe::read_design_folder(arguments.out)) {
    display::add_notes(set_aside_outliers(*design), warnings);
  }
  console.out << (arguments.json ? design_json(arguments, plan, before, warnings)
                                 : design_words(arguments, plan, before, warnings));
  return kSuccess;
}

}  // namespace recald::daemon
