#include <fmt/format.h>

#include <chrono>
#include <cstdlib>

#include "adapters/models/model_store.hpp"
#include "adapters/report/diagnosis_page.hpp"
#include "adapters/system/write_file.hpp"
#include "daemon/calibrate/active_effects.hpp"
#include "daemon/commands/commands.hpp"
#include "daemon/commands/interrupt.hpp"
#include "daemon/commands/open_site.hpp"
#include "daemon/diagnose/diagnosis_files.hpp"
#include "daemon/diagnose/diagnosis_report.hpp"
#include "daemon/diagnose/diagnosis_words.hpp"
#include "daemon/diagnose/epc_gap.hpp"
#include "daemon/diagnose/site_problem.hpp"

namespace recald::daemon {
namespace {

/// The wall clock is read here and nowhere deeper. SOURCE_DATE_EPOCH makes the page repeatable.
std::string now_text() {
  if (const char* fixed = std::getenv("SOURCE_DATE_EPOCH")) {
    return metering::to_string(metering::Instant{std::chrono::seconds{std::atoll(fixed)}});
  }
  return metering::to_string(
      std::chrono::floor<std::chrono::seconds>(std::chrono::system_clock::now()));
}

/// Stores the additions as a version that is not in force yet. @return its name
Result<std::string> store_version(const models::ModelStore& store, const ModelledSite& modelled,
                                  const diagnosis::Diagnosis& diagnosis,
                                  const diagnosis::SiteProblem& site, const std::string& at) {
  const auto parent = store.active();
  if (!parent) return tl::unexpected(parent.error());
  auto saved = store.save(next_version(diagnosis, site, *parent, modelled.facts, at));
  if (!saved) return tl::unexpected(saved.error());
  return std::move(saved->version);
}

/// The diagnosis, with progress on a terminal. @return cancelled after an interrupt, too
Result<diagnosis::Diagnosis> diagnose_aloud(const diagnosis::SiteProblem& problem,
                                            std::uint64_t seed, const Console& console) {
  const InterruptGuard guard;
  const auto observer = [&](const char* what, double share) {
    if (console.is_terminal) console.err << fmt::format("\r{:3.0f} %  {:<32}", 100.0 * share, what);
    return !guard.interrupted();
  };
  auto diagnosis = diagnosis::diagnose(problem, {.rules = {}, .seed = seed}, observer);
  if (console.is_terminal) console.err << "\r\033[K";
  return diagnosis;
}

/// What the same effects do to the monthly model, which has a vote: where it tells the months kept
/// back worse with them, they are not confirmed. Empty where there was nothing to judge.
/// @see discrepancy.md, 3.4.
std::vector<ModelGap> ask_monthly_model(const ModelledSite& modelled,
                                        const diagnosis::SiteProblem& problem,
                                        diagnosis::Diagnosis& diagnosis) {
  if (!diagnosis.gap) return {};
  auto monthly = epc_gap(modelled.site.config, modelled.site.calendar, modelled.recording,
                         modelled.weather, problem, diagnosis.added);
  if (!monthly) {
    diagnosis.warnings.push_back("The monthly model was not asked: " + monthly.error().message +
                                 ".");
    return {};
  }
  if (!diagnosis.not_confirmed && !monthly->agrees()) {
    diagnosis.not_confirmed = true;
    diagnosis.outcome = diagnosis::Outcome::unknown;
    diagnosis.why =
        "with what was named the monthly model tells the months that were kept back worse, so it "
        "was taken back";
  }
  return {std::move(monthly->gap)};
}

/// The page first: diagnosis.json says that all is there. It goes before a new page comes, so that
/// no interruption leaves a result beside the page of another.
Result<void> write_all(const std::filesystem::path& folder, const std::string& json,
                       const std::string& page) {
  if (auto made = system::make_folder(folder); !made) return made;
  std::error_code ignored;  // what cannot be removed cannot be written either, which is reported
  std::filesystem::remove(folder / "diagnosis.json", ignored);
  if (auto written = system::write_file(folder / "diagnosis.html", page); !written) return written;
  return system::write_file(folder / "diagnosis.json", json);
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

  auto diagnosis = diagnose_aloud(*problem, arguments.seed, console);
  if (!diagnosis) return console.fail(diagnosis.error());
  const std::vector<ModelGap> others = ask_monthly_model(*modelled, *problem, *diagnosis);

  const std::string at = now_text();
  const models::ModelStore store{modelled->site.config.file, modelled->site.config.id};
  const bool keep = arguments.apply && !diagnosis->added.empty() && !diagnosis->not_confirmed;
  std::string applied;
  if (keep) {
    auto version = store_version(store, *modelled, *diagnosis, *problem, at);
    if (!version) return console.fail(version.error());
    modelled->facts.model_version = applied = std::move(*version);
  }
  modelled->facts.seed = arguments.seed;
  modelled->facts.wall_s =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  const std::string json = diagnosis_json(*diagnosis, *problem, modelled->facts, others);
  if (!arguments.out.empty()) {
    const std::string page = report::render_diagnosis(diagnosis_report_of(
        modelled->site.config, *diagnosis, *problem, modelled->facts, at, others));
    if (auto written = write_all(arguments.out, json, page); !written) {
      return console.fail(written.error());
    }
  }
  // Last of all: what is in force has its page.
  if (keep) {
    if (auto active = store.activate(applied, at); !active) return console.fail(active.error());
  }
  console.out << (arguments.json ? json : diagnosis_words(*diagnosis, *problem));
  if (!applied.empty() && !arguments.json) {
    console.out << "Model version " << diagnosis::short_version(applied) << " is in force.\n";
  }
  return kSuccess;
}

}  // namespace recald::daemon
