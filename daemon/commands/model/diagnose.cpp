#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <span>
#include <utility>

#include "adapters/models/model_store.hpp"
#include "adapters/system/files/write_file.hpp"
#include "adapters/system/parallel_for.hpp"
#include "adapters/views/diagnosis/diagnosis_files.hpp"
#include "adapters/views/diagnosis/diagnosis_words.hpp"
#include "core/diagnosis/effects/support/effect.hpp"
#include "core/display/warning.hpp"
#include "core/text/nearest.hpp"
#include "core/text/printable.hpp"
#include "daemon/commands/commands.hpp"
#include "daemon/commands/generated_at.hpp"
#include "daemon/commands/interrupt.hpp"
#include "daemon/commands/model/engine_runs.hpp"
#include "daemon/commands/open_site.hpp"
#include "daemon/site/diagnose/energyplus_gap.hpp"
#include "daemon/site/diagnose/proposed_version.hpp"
#include "daemon/site/diagnose/site_diagnosis.hpp"
#include "daemon/site/model/energyplus_effects.hpp"
#include "daemon/site/results/diagnosis_folder.hpp"

namespace recald::daemon {
namespace {

bool has_energyplus(const SiteConfig& site) {
  return std::ranges::any_of(site.other_models,
                             [](const ModelConfig& model) { return model.energyplus.has_value(); });
}

/// Gives the site's EnergyPlus model the effects, makes the runs that it needs for that, and asks
/// it whether it predicts the held-out months better with them.
/// @return why it could not be asked
Result<diagnosis::MonthlyVote> ask_energyplus(const ModelledSite& modelled,
                                              const diagnosis::SiteProblem& problem,
                                              const diagnosis::ModelVersion& version,
                                              std::span<const diagnosis::Addition> added,
                                              std::uint64_t seed, const Console& console) {
  ModelledSite on_runs = modelled;
  SiteConfig& site = on_runs.site.config;
  TRY(choose_model(site, ModelKind::energyplus));
  for (const std::string& output : site.model->outputs) {
    if (site.meter_index(output)) continue;
    return failure(ErrorCode::not_found,
                   fmt::format("its meter '{}' was not read, because the hourly model has no such "
                               "output",
                               output));
  }
  TRY(take_in_effects(version, *site.model));
  if (!has_all_runs(site)) {
    console.err << fmt::format("The EnergyPlus model gets the effect too: {} runs into '{}'.\n",
                               site.model->energyplus->runs,
                               site.model->energyplus->design.string());
    if (!make_runs_aloud(on_runs, {.seed = seed}, 0, console)) {
      return failure(ErrorCode::not_found, "its runs could not be made");
    }
  }
  return energyplus_gap(on_runs, problem, added, seed);
}

/// The diagnosis, with progress on a terminal. @return cancelled after an interrupt, too
Result<SiteDiagnosis> diagnose_aloud(const ModelledSite& modelled,
                                     const diagnosis::SiteProblem& problem,
                                     const DiagnoseArguments& arguments, const Console& console) {
  const InterruptGuard guard;
  ProgressLine line{console};
  const auto observer = [&](const char*, double share) {
    line.show("Looking for missing effects", share);
    return !guard.interrupted();
  };
  return diagnose_site(modelled, problem,
                       {.rules = {},
                        .prior_none = modelled.site.config.prior_none,
                        .seed = arguments.seed,
                        .assumed = arguments.assumed,
                        .executor = system::parallel_for(arguments.threads)},
                       observer);
}

/// What became of the model, for people.
std::string fate_words(const diagnosis::Diagnosis& diagnosis, const DiagnoseArguments& arguments,
                       const std::string& applied) {
  if (!applied.empty()) {
    return fmt::format("Model version {} is now in force.\n", diagnosis::short_version(applied));
  }
  if (arguments.apply) return "No effect was added. The model was not changed.\n";
  if (diagnosis.added.empty() || diagnosis.not_confirmed) return {};
  return fmt::format("The model was not changed. Run again with --apply to add {}.\n",
                     diagnosis.added.size() == 1 ? "this effect" : "these effects");
}

/// Of EFFECT:METER; what is wrong with a name, found before the readings are.
std::string wrong_assumption(const DiagnoseArguments& arguments) {
  for (const std::string& assumed : arguments.assumed) {
    const std::string effect = assumed.substr(0, assumed.find(':'));
    if (diagnosis::find_effect(effect) == nullptr) return "--assume: " + no_such_effect(effect);
  }
  return {};
}

/// The same of its meter, which the site has to have.
std::string wrong_meter(const DiagnoseArguments& arguments, const SiteConfig& site) {
  for (const std::string& assumed : arguments.assumed) {
    const auto colon = assumed.find(':');
    if (colon == std::string::npos) continue;
    const std::string meter = assumed.substr(colon + 1);
    if (site.meter_index(meter)) continue;
    std::vector<std::string_view> ids;
    for (const MeterConfig& one : site.meters) ids.push_back(one.meter.id);
    const std::string_view nearest = nearest_name(meter, ids);
    return fmt::format(
        "--assume: there is no meter '{}'; {}", printable(meter),
        nearest.empty() ? "see recald check" : fmt::format("did you mean '{}'?", nearest));
  }
  return {};
}

}  // namespace

int run_diagnose(const DiagnoseArguments& arguments, const Console& console) {
  const auto begin = std::chrono::steady_clock::now();
  if (const std::string why = wrong_assumption(arguments); !why.empty()) {
    return console.misused(why);
  }
  auto modelled = open_modelled_site(arguments.site, console, ModelKind::hourly);
  if (!modelled) return modelled.error();
  if (const std::string why = wrong_meter(arguments, modelled->site.config); !why.empty()) {
    return console.misused(why);
  }
  const auto problem = prepare_diagnosis(*modelled);
  if (!problem) return console.fail(problem.error());
  if (!arguments.out.empty()) {
    if (auto made = system::make_folder(arguments.out); !made) return console.fail(made.error());
  }
  auto done = diagnose_aloud(*modelled, *problem, arguments, console);
  if (!done) return console.fail(done.error());
  const diagnosis::Diagnosis& diagnosis = done->diagnosis;
  const InterruptGuard until_written;

  const auto fail = [&](const Error& error) {
    // What was found is not lost with a full disk.
    if (!arguments.json) console.out << views::diagnosis_words(diagnosis, *problem, done->others);
    return console.fail(error);
  };
  const std::string at = generated_at();
  const models::ModelStore store{modelled->site.config.versions_beside(), modelled->site.config.id};
  const auto is_kept = [&] {
    return arguments.apply && !diagnosis.added.empty() && !diagnosis.not_confirmed;
  };
  std::string applied;
  if (is_kept()) {
    const auto version =
        propose_version(store, *modelled, diagnosis, *problem, at, diagnosis::VersionAuthor::human);
    if (!version) return fail(version.error());
    if (has_energyplus(modelled->site.config)) {
      auto vote =
          ask_energyplus(*modelled, *problem, *version, diagnosis.added, arguments.seed, console);
      if (until_written.interrupted()) return fail(diagnosis::diagnosis_cancelled());
      if (vote) {
        take_vote(std::move(*vote), "the EnergyPlus model", *done);
      } else {
        done->diagnosis.warnings.push_back(display::warning_of(
            "The EnergyPlus model was not asked: " + vote.error().message + "."));
      }
    }
    if (is_kept()) modelled->facts.model_version = applied = version->version;
  }
  modelled->facts.seed = arguments.seed;
  modelled->facts.wall_s =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  const std::string json =
      views::diagnosis_json(diagnosis, *problem, modelled->facts, done->others);
  if (!arguments.out.empty()) {
    const auto written = write_diagnosis(*done, *modelled, *problem, json, at, arguments.out);
    if (!written) return fail(written.error());
  }
  // Last of all: what is in force has its page.
  if (!applied.empty()) {
    if (auto active = store.activate(applied, at); !active) return fail(active.error());
  }
  console.out << (arguments.json ? json
                                 : views::diagnosis_words(diagnosis, *problem, done->others) +
                                       fate_words(diagnosis, arguments, applied));
  return kSuccess;
}

}  // namespace recald::daemon
