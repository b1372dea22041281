#include <fmt/format.h>

#include <chrono>

#include "adapters/models/model_store.hpp"
#include "adapters/system/write_file.hpp"
#include "daemon/calibrate/active_effects.hpp"
#include "daemon/commands/commands.hpp"
#include "daemon/commands/interrupt.hpp"
#include "daemon/commands/open_site.hpp"
#include "daemon/diagnose/diagnosis_files.hpp"
#include "daemon/diagnose/site_problem.hpp"

namespace recald::daemon {
namespace {

std::string now_text() {
  return metering::to_string(
      std::chrono::floor<std::chrono::seconds>(std::chrono::system_clock::now()));
}

/// Puts the additions in force. @return the version's name, or what the store refuses
Result<std::string> apply(const ModelledSite& modelled, const diagnosis::Diagnosis& diagnosis,
                          const diagnosis::SiteProblem& site) {
  const SiteConfig& config = modelled.site.config;
  const models::ModelStore store{config.file, config.id};
  const auto parent = store.active();
  if (!parent) return tl::unexpected(parent.error());
  const std::string at = now_text();
  auto saved = store.save(next_version(diagnosis, site, *parent, modelled.facts, at));
  if (!saved) return tl::unexpected(saved.error());
  const auto active = store.activate(saved->version, at);
  if (!active) return tl::unexpected(active.error());
  return active->version;
}

}  // namespace

int run_diagnose(const DiagnoseArguments& arguments, const Console& console) {
  const auto begin = std::chrono::steady_clock::now();
  auto modelled = open_modelled_site(arguments.site, console, "hourly");
  if (!modelled) return modelled.error();
  const auto present = active_effects(modelled->site.config);
  if (!present) return console.fail(present.error());
  if (!present->empty()) {
    return console.fail(fmt::format(
        "the model has '{}' already, and a diagnosis starts from the drawings; revert first with "
        "`recald model revert {}`",
        present->front().effect, arguments.site.string()));
  }
  auto problem = make_site_problem(modelled->site.config, modelled->site.calendar,
                                   modelled->recording, modelled->weather);
  if (!problem) return console.fail(problem.error());

  const InterruptGuard guard;
  const auto observer = [&](const char* what, double share) {
    if (console.is_terminal) console.err << fmt::format("\r{:3.0f} %  {:<32}", 100.0 * share, what);
    return !guard.interrupted();
  };
  const auto diagnosis =
      diagnosis::diagnose(*problem, {.rules = {}, .seed = arguments.seed}, observer);
  if (console.is_terminal) console.err << "\r\033[K";
  if (!diagnosis) return console.fail(diagnosis.error());

  std::string applied;
  if (arguments.apply && !diagnosis->added.empty() && !diagnosis->not_confirmed) {
    auto version = apply(*modelled, *diagnosis, *problem);
    if (!version) return console.fail(version.error());
    applied = std::move(*version);
  }
  modelled->facts.seed = arguments.seed;
  modelled->facts.wall_s =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  const std::string json = diagnosis_json(*diagnosis, *problem, modelled->facts, applied);
  if (!arguments.out.empty()) {
    if (auto made = system::make_folder(arguments.out); !made) return console.fail(made.error());
    if (auto written = system::write_file(arguments.out / "diagnosis.json", json); !written) {
      return console.fail(written.error());
    }
  }
  console.out << (arguments.json ? json : diagnosis_words(*diagnosis, *problem));
  if (!applied.empty() && !arguments.json) {
    console.out << "Model version " << diagnosis::short_version(applied) << " is in force.\n";
  }
  return kSuccess;
}

}  // namespace recald::daemon
