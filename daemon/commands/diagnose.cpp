#include <fmt/format.h>
#include <fmt/ranges.h>

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
                                            const DiagnoseArguments& arguments,
                                            const Console& console) {
  const InterruptGuard guard;
  const auto observer = [&](const char* what, double share) {
    if (console.is_terminal) console.err << fmt::format("\r{:3.0f} %  {:<32}", 100.0 * share, what);
    return !guard.interrupted();
  };
  auto diagnosis = diagnosis::diagnose(
      problem, {.rules = {}, .seed = arguments.seed, .assumed = arguments.assumed}, observer);
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
  if (!monthly->has_vote()) {
    diagnosis.warnings.emplace_back(
        "The monthly model had no say: no meter has a usable monthly figure in the months kept "
        "back.");
  } else if (!diagnosis.not_confirmed && !monthly->agrees()) {
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
/// @pre the folder is there
Result<void> write_all(const std::filesystem::path& folder, const std::string& json,
                       const std::string& page) {
  std::error_code ignored;  // what cannot be removed cannot be written either, which is reported
  std::filesystem::remove(folder / "diagnosis.json", ignored);
  if (auto written = system::write_file(folder / "diagnosis.html", page); !written) return written;
  return system::write_file(folder / "diagnosis.json", json);
}

/// A diagnosis starts from the drawings.
Result<void> require_drawings(const SiteConfig& site, const std::filesystem::path& file) {
  const auto present = active_version(site);
  if (!present) return tl::unexpected(present.error());
  if (present->effects.empty()) return {};
  std::vector<std::string> titles;
  for (const auto& effect : present->effects) titles.push_back("'" + effect.title + "'");
  return failure(
      ErrorCode::unsupported,
      fmt::format("the model has {} already (version {}), and a diagnosis starts from the "
                  "drawings; take it back first with `recald model revert {} {}`",
                  fmt::join(titles, ", "), diagnosis::short_version(present->version),
                  file.string(), diagnosis::kBaseVersion));
}

/// All that can be told before the long part, so that nobody waits for a refusal.
Result<diagnosis::SiteProblem> prepare(const ModelledSite& modelled,
                                       const DiagnoseArguments& arguments) {
  const SiteConfig& config = modelled.site.config;
  if (auto plain = require_drawings(config, arguments.site); !plain) {
    return tl::unexpected(plain.error());
  }
  if (auto enough = require_months(config, modelled.recording, modelled.weather); !enough) {
    return tl::unexpected(enough.error());
  }
  auto problem =
      make_site_problem(config, modelled.site.calendar, modelled.recording, modelled.weather);
  if (!problem) return problem;
  if (!arguments.out.empty()) {
    if (auto made = system::make_folder(arguments.out); !made) return tl::unexpected(made.error());
  }
  return problem;
}

/// What became of the model, for people.
std::string fate_words(const diagnosis::Diagnosis& diagnosis, const DiagnoseArguments& arguments,
                       const std::string& applied) {
  if (!applied.empty()) {
    return fmt::format("Model version {} is in force.\n", diagnosis::short_version(applied));
  }
  if (arguments.apply) return "Nothing was put in force: the model is as it was.\n";
  if (diagnosis.added.empty() || diagnosis.not_confirmed) return {};
  return "The model is as it was; with --apply it gets what was named.\n";
}

}  // namespace

int run_diagnose(const DiagnoseArguments& arguments, const Console& console) {
  const auto begin = std::chrono::steady_clock::now();
  auto modelled = open_modelled_site(arguments.site, console, "hourly");
  if (!modelled) return modelled.error();
  const auto problem = prepare(*modelled, arguments);
  if (!problem) return console.fail(problem.error());

  auto diagnosis = diagnose_aloud(*problem, arguments, console);
  if (!diagnosis) return console.fail(diagnosis.error());
  const auto words = data_words(modelled->site.config, modelled->recording, modelled->weather);
  diagnosis->warnings.insert(diagnosis->warnings.begin(), words.begin(), words.end());
  const std::vector<ModelGap> others = ask_monthly_model(*modelled, *problem, *diagnosis);

  const auto fail = [&](const Error& error) {
    // What was found is not lost with a full disk.
    if (!arguments.json) console.out << diagnosis_words(*diagnosis, *problem, others);
    return console.fail(error);
  };
  const std::string at = now_text();
  const models::ModelStore store{modelled->site.config.file, modelled->site.config.id};
  const bool keep = arguments.apply && !diagnosis->added.empty() && !diagnosis->not_confirmed;
  std::string applied;
  if (keep) {
    auto version = store_version(store, *modelled, *diagnosis, *problem, at);
    if (!version) return fail(version.error());
    modelled->facts.model_version = applied = std::move(*version);
  }
  modelled->facts.seed = arguments.seed;
  modelled->facts.wall_s =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  const std::string json = diagnosis_json(*diagnosis, *problem, modelled->facts, others);
  if (!arguments.out.empty()) {
    const std::string page = report::render_diagnosis(diagnosis_report_of(
        modelled->site.config, *diagnosis, *problem, modelled->facts, at, others));
    if (auto written = write_all(arguments.out, json, page); !written) return fail(written.error());
  }
  // Last of all: what is in force has its page.
  if (keep) {
    if (auto active = store.activate(applied, at); !active) return fail(active.error());
  }
  console.out << (arguments.json ? json
                                 : diagnosis_words(*diagnosis, *problem, others) +
                                       fate_words(*diagnosis, arguments, applied));
  return kSuccess;
}

}  // namespace recald::daemon
