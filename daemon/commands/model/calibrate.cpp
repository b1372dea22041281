#include <fmt/format.h>

#include <chrono>
#include <sstream>
#include <vector>

#include "adapters/system/files/write_file.hpp"
#include "daemon/commands/generated_at.hpp"
#include "daemon/commands/model/calibrate_aloud.hpp"
#include "daemon/commands/model/calibration_options.hpp"
#include "daemon/commands/model/engine_runs.hpp"
#include "daemon/commands/open_site.hpp"
#include "daemon/site/results/calibration_files.hpp"
#include "daemon/site/results/calibration_folder.hpp"
#include "daemon/site/results/comparison.hpp"

namespace recald::daemon {
namespace {

/// A site without a model still has forecasts, where it has a temperature.
tl::expected<ModelledSite, int> open_for_calibration(const CalibrateArguments& arguments,
                                                     const Console& console) {
  auto site = open_site(arguments.site);
  if (!site || site->config.model || !site->config.weather) {
    return open_modelled_site(arguments.site, console, arguments.model);
  }
  if (arguments.model || arguments.prior_sensitivity || arguments.predictive ||
      arguments.discrepancy != "sound") {
    return tl::unexpected(console.fail(fmt::format(
        "{} has no [[model]], so --model, --discrepancy, --predictive and --prior-sensitivity have "
        "nothing to act on; leave them out",
        arguments.site.filename().string())));
  }
  return load_aloud(std::move(*site), console);
}

/// An EnergyPlus model needs its runs; those that are missing are made.
tl::expected<ModelledSite, int> open_with_runs(const CalibrateArguments& arguments,
                                               const Console& console) {
  return with_runs([&](const Console& to) { return open_for_calibration(arguments, to); },
                   arguments.seed, arguments.threads, console);
}

}  // namespace

tl::expected<FinishedCalibration, int> calibrate_aloud(const CalibrateArguments& arguments,
                                                       const Console& console) {
  const auto begin = std::chrono::steady_clock::now();
  auto calibration = TRY(calibration_options(arguments, console));
  calibration.design_runs = arguments.design_runs;
  const CalibrateOptions options{
      std::move(calibration), arguments.prior_sensitivity,
      arguments.discrepancy == "seed" ? DiscrepancyForm::seed : DiscrepancyForm::sound};
  auto modelled = TRY(open_with_runs(arguments, console));

  const InterruptGuard guard;
  ProgressLine line{console};
  auto done = finish_calibration(std::move(modelled), options, run_context(arguments, guard, line));
  if (!done) return tl::unexpected(console.fail(done.error()));
  done->modelled.facts.wall_s =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  return std::move(*done);
}

namespace {

/// The site's other models, one after the other; what stops one of them is noted, not fatal.
void calibrate_others(const CalibrateArguments& arguments, const Console& console,
                      std::vector<SiteModelResult>& models) {
  const std::vector<ModelConfig> others = models.front().done->modelled.site.config.other_models;
  for (const ModelConfig& model : others) {
    CalibrateArguments of_model = arguments;
    of_model.model = model.kind;
    std::ostringstream messages;
    if (model.energyplus) {  // hours may pass: its progress is seen
      const auto with_runs = open_with_runs(of_model, console);
      if (!with_runs) {
        models.push_back(
            {model.kind, failure(ErrorCode::unsupported, "its runs are not complete")});
        continue;
      }
    }
    auto done = calibrate_aloud(of_model, {console.out, messages, false, Console::Detail::little});
    if (done) {
      models.push_back({model.kind, std::move(*done)});
      continue;
    }
    std::string sentence = messages.str();
    while (sentence.ends_with('\n')) sentence.pop_back();
    sentence = sentence.substr(sentence.rfind('\n') + 1);
    models.push_back({model.kind, failure(ErrorCode::unsupported, sentence)});
  }
}

/// The first model's files as ever, with all models in its page; the others' in folders of their
/// own.
Result<void> write_models(const std::vector<SiteModelResult>& models, const std::string& json,
                          const std::filesystem::path& folder) {
  const FinishedCalibration& first = *models.front().done;
  if (models.size() == 1) return write_calibration(first, json, generated_at(), folder);
  for (std::size_t i = 1; i < models.size(); ++i) {
    if (!models[i].done) continue;
    const FinishedCalibration& done = *models[i].done;
    auto written = write_calibration(done, calibration_json(done.calibration, done.modelled.facts),
                                     generated_at(), folder / name_of(models[i].kind));
    if (!written) return written;
  }
  if (auto made = system::make_folder(folder); !made) return made;
  if (auto written =
          system::write_file(folder / "comparison.json", comparison_json(models).dump(2) + "\n");
      !written) {
    return written;
  }
  return write_calibration(first, json, generated_at(), folder, compared_models(models));
}

}  // namespace

int run_calibrate(const CalibrateArguments& arguments, const Console& console) {
  if (!arguments.design.folder.empty()) return run_calibrate_design(arguments, console);
  auto done = calibrate_aloud(arguments, console);
  if (!done) return done.error();
  std::vector<SiteModelResult> models;
  models.push_back({done->calibration.model, std::move(*done)});
  if (!arguments.model) calibrate_others(arguments, console, models);
  const InterruptGuard until_written;
  const FinishedCalibration& first = *models.front().done;
  const std::string json = calibration_json(first.calibration, first.modelled.facts);
  const int code = deliver(
      first.calibration, json, arguments, console,
      [&](const std::filesystem::path& folder) { return write_models(models, json, folder); });
  if (models.size() > 1 && !arguments.json) console.out << comparison_words(models);
  return code;
}

}  // namespace recald::daemon
