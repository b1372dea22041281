#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "adapters/doe/folder_engine.hpp"
#include "adapters/system/parallel_for.hpp"
#include "core/display/warning.hpp"
#include "daemon/commands/commands.hpp"
#include "daemon/commands/interrupt.hpp"
#include "daemon/commands/model/engine_runs.hpp"
#include "daemon/commands/open_site.hpp"
#include "daemon/site/calibrate/design_origin.hpp"
#include "daemon/site/calibrate/design_outliers.hpp"
#include "daemon/site/calibrate/design_plan.hpp"
#include "daemon/site/calibrate/site_runs.hpp"
#include "daemon/site/model/active_effects.hpp"

namespace recald::daemon {
namespace {

constexpr int kUsualRuns = 200;

std::string design_json(const std::filesystem::path& folder, std::uint64_t seed,
                        const MadeRuns& made, const display::Warnings& warnings) {
  const nlohmann::ordered_json json = {{"folder", folder.string()},
                                       {"runs", made.total},
                                       {"runs_before", made.before},
                                       {"runs_failed", made.failed},
                                       {"parameters", made.parameters},
                                       {"outputs", made.outputs},
                                       {"months", made.months},
                                       {"seed", seed},
                                       {"warnings", display::texts_of(warnings)}};
  return json.dump(2) + "\n";
}

std::string design_words(const std::filesystem::path& folder, const MadeRuns& made,
                         const display::Warnings& warnings) {
  std::string text =
      fmt::format("{}: {} runs of {} parameters, {} outputs in {} months", folder.string(),
                  made.total, made.parameters.size(), made.outputs.size(), made.months);
  text += made.before == 0 ? ".\n" : fmt::format("; {} of them already existed.\n", made.before);
  if (made.failed > 0) {
    text += fmt::format("{} of them failed; {} says why.\n", made.failed,
                        (folder / "failed.csv").string());
  }
  return text + display::warning_lines(warnings);
}

design::Points points_of(const DoeArguments& arguments) {
  if (arguments.from_priors) return design::Points::priors;
  return arguments.at_corners ? design::Points::corners : design::Points::wide;
}

/// A design of one of our own models.
tl::expected<MadeRuns, int> make_built_in_runs(const ModelledSite& modelled,
                                               const DoeArguments& arguments,
                                               const Console& console,
                                               display::Warnings& warnings) {
  const auto& [site, recording, weather, facts] = modelled;
  const auto version = active_version(site.config);
  if (!version) return tl::unexpected(console.fail(version.error()));
  const auto prepared =
      prepare_site(site.config, site.calendar, recording, weather, version->effects);
  if (!prepared) return tl::unexpected(console.fail(prepared.error()));
  const SiteDesignOptions options{
      .runs = arguments.runs.value_or(kUsualRuns),
      .seed = arguments.seed,
      .points = points_of(arguments),
      .fingerprint = fmt::format("{} {} {}", version_name(*version, facts.model_version),
                                 facts.data_revision, facts.recald_version)};
  const doe::DesignPlan plan = plan_design(*prepared, options);

  const InterruptGuard guard;
  auto engine = site_engine(*prepared);
  auto folder = doe::FolderEngine::open(arguments.out, plan, &engine);
  if (!folder) return tl::unexpected(console.fail(folder.error()));
  MadeRuns made{.outputs = plan.output_names,
                .months = plan.months.size(),
                .total = static_cast<int>(plan.theta.rows()),
                .before = folder->done_count()};
  for (const Parameter& parameter : plan.parameters) made.parameters.push_back(parameter.name);
  const auto runs = [&] {
    ProgressLine line{console};
    return folder->run(plan.theta, system::parallel_for(arguments.threads),
                       [&](int done, int total) {
                         line.show({calibration::Progress::Stage::design, 0, done, total});
                         return !guard.interrupted();
                       });
  }();
  if (!runs) return tl::unexpected(console.fail(runs.error()));
  if (auto noted = note_site(arguments.out, arguments.site, version->effects); !noted) {
    return tl::unexpected(console.fail(noted.error()));
  }
  warnings = prepared->so_far.warnings;
  return made;
}

}  // namespace

int run_doe(const DoeArguments& arguments, const Console& console) {
  auto modelled = open_modelled_site(arguments.site, console, arguments.model);
  if (!modelled) return modelled.error();
  const ModelConfig& model = *modelled->site.config.model;
  const std::filesystem::path folder =
      arguments.out.empty() && model.energyplus ? model.energyplus->design : arguments.out;
  if (folder.empty()) return console.misused("give the design folder with --out");
  if (points_of(arguments) != design::Points::wide && arguments.out.empty()) {
    return console.misused(
        "--priors and --corners make runs that check a design; give them a folder of their own "
        "with --out");
  }
  display::Warnings warnings;
  auto made = model.energyplus ? make_runs_aloud(*modelled,
                                                 {.folder = folder,
                                                  .runs = arguments.runs.value_or(0),
                                                  .seed = arguments.seed,
                                                  .points = points_of(arguments)},
                                                 arguments.threads, console)
                               : make_built_in_runs(*modelled, arguments, console, warnings);
  if (!made) return made.error();
  display::add_notes(made->notes, warnings);
  if (auto design = doe::read_design_folder(folder)) {
    display::add_notes(set_aside_outliers(*design), warnings);
  }
  console.out << (arguments.json ? design_json(folder, arguments.seed, *made, warnings)
                                 : design_words(folder, *made, warnings));
  return kSuccess;
}

}  // namespace recald::daemon
