#include "daemon/site/savings/measure_runs.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <utility>

#include "adapters/doe/days_file.hpp"
#include "adapters/system/files/sha256.hpp"
#include "core/design/latin_hypercube.hpp"
#include "core/random/streams.hpp"
#include "daemon/site/model/energyplus_site.hpp"
#include "daemon/site/savings/measure_columns.hpp"

namespace recald::daemon {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using savings::Change;
using savings::Measure;

constexpr std::uint64_t kExtentSeed = 1;  // the same runs whenever they are asked for
constexpr std::size_t kNameDigits = 16;
/// Runs that are repeated with a measure: what it saves depends less on the parameters than the use
/// does, so fewer are needed than in the design.
constexpr Index kMeasureRuns = 60;
/// More than the columns that what is saved is fitted to.
constexpr Index kSpareRuns = 20;

/// EnergyPlus with measures: a row has the model's parameters and the extents that are not known.
class EngineWithMeasures final : public Engine {
 public:
  EngineWithMeasures(energyplus::EnergyPlusEngine& engine, const MeasureColumns& columns)
      : engine_{engine}, columns_{columns} {
    for (const auto& column : engine.targeted()) designs_.push_back(column.design);
  }

  Result<MatrixXd> run(const MatrixXd& theta, const ForEachIndex& executor,
                       const Observer& observer) override {
    return engine_.run(columns_.changed(theta, designs_), executor, observer);
  }
  [[nodiscard]] std::vector<FailedRun> failed_runs() const override {
    return engine_.failed_runs();
  }
  [[nodiscard]] bool keeps_runs() const override { return true; }

 private:
  energyplus::EnergyPlusEngine& engine_;
  const MeasureColumns& columns_;
  std::vector<double> designs_;
};

/// The design's months and the weather that its runs had.
Result<RunMonths> months_of_runs(const doe::DesignFolder& design) {
  RunMonths runs;
  for (const doe::DesignMonth& name : design.months) {
    const auto month = TRY(metering::parse_month(name.text()));
    const int year = static_cast<int>(month.year());
    const auto file = design.folder / kWeatherYears / fmt::format("{}.epw", year);
    std::error_code ignored;
    if (!std::filesystem::exists(file, ignored)) {
      return failure(ErrorCode::not_found,
                     fmt::format("the weather of the runs is gone: {} is not there; give the model "
                                 "another 'design' folder, and make the runs again",
                                 file.string()));
    }
    runs.months.push_back(month);
    runs.weather[year] = file;
  }
  return runs;
}

/// The first runs of the design, with an extent drawn for each change that needs one.
doe::DesignPlan plan_of(const doe::DesignFolder& design, const MeasureColumns& columns,
                        std::string fingerprint) {
  doe::DesignPlan plan{.parameters = design.parameters,
                       .theta = {},
                       .output_names = design.output_names,
                       .months = design.months,
                       .inputs = design.inputs,
                       .measurements = {design.months, design.output_names, {}},
                       .seed = kExtentSeed,
                       .fingerprint = std::move(fingerprint)};
  plan.measurements.values.setConstant(std::ssize(design.months), std::ssize(design.output_names),
                                       kAbsent);
  const std::vector<Parameter>& extents = columns.extents();
  const Index q = design.theta.cols();
  const Index enough = std::max(kMeasureRuns, q + std::ssize(extents) + kSpareRuns);
  const Index runs = std::min(enough, design.theta.rows());
  plan.theta.resize(runs, q + std::ssize(extents));
  plan.theta.leftCols(q) = design.theta.topRows(runs);
  if (!extents.empty()) {
    Rng rng{kExtentSeed, streams::kHypercube.first};
    plan.theta.rightCols(std::ssize(extents)) =
        design::latin_hypercube(extents, static_cast<int>(runs), rng);
  }
  plan.parameters.insert(plan.parameters.end(), extents.begin(), extents.end());
  return plan;
}

/// Whether EnergyPlus would make the design's runs today as it made them.
Result<void> require_same_runs(const ModelledSite& modelled, const RunMonths& months,
                               const std::filesystem::path& design,
                               const std::function<bool()>& keep_going,
                               std::vector<std::string>& notes) {
  const auto plain = TRY(make_energyplus_engine(modelled.site, *modelled.site.config.model, months,
                                                {}, keep_going, notes));
  if (doe::fingerprint_of(design) == plain->fingerprint()) return {};
  return failure(
      ErrorCode::invalid_value,
      fmt::format("the runs in '{}' were made with another version of EnergyPlus, another interval "
                  "of the site or other weather, so that runs with a measure cannot be compared "
                  "with them; give the model another 'design' folder, and make the runs again",
                  design.string()));
}

Result<void> copy_weather(const std::filesystem::path& from, const std::filesystem::path& to) {
  std::error_code failed;
  std::filesystem::copy_file(from / kRunsWeather, to / kRunsWeather,
                             std::filesystem::copy_options::overwrite_existing, failed);
  if (!failed) return {};
  return failure(ErrorCode::io_failed,
                 fmt::format("cannot copy {} to {}: {}", (from / kRunsWeather).string(),
                             to.string(), failed.message()));
}

}  // namespace

std::filesystem::path measure_folder(const ModelConfig& model, std::span<const Measure> measures) {
  system::Sha256 digest;
  for (const Measure& measure : measures) {
    for (const Change& change : measure.changes) {
      digest.add(fmt::format("{} [{}] {} {:a} {:a} {:a}\n", change.parameter,
                             fmt::join(change.targets, " "), static_cast<int>(change.kind),
                             change.by.min, change.by.mode, change.by.max));
    }
  }
  return model.energyplus->design / "measures" / digest.hex().substr(0, kNameDigits);
}

bool has_measure_runs(const ModelConfig& model, std::span<const Measure> measures) {
  const std::filesystem::path folder = measure_folder(model, measures);
  std::error_code ignored;
  return doe::read_design_folder(folder).has_value() &&
         std::filesystem::exists(doe::days_file(folder), ignored) &&
         std::filesystem::exists(folder / kRunsWeather, ignored);
}

Result<MadeRuns> make_measure_runs(const ModelledSite& modelled, std::span<const Measure> measures,
                                   const ForEachIndex& executor, const Engine::Observer& observer) {
  const ModelConfig& model = *modelled.site.config.model;
  const auto lock = TRY(lock_runs(model.energyplus->design));
  const auto design = TRY(doe::read_design_folder(model.energyplus->design));
  const auto months = TRY(months_of_runs(design));
  const auto keep_going = [&] { return !observer || observer(0, 0); };
  std::vector<std::string> notes;
  TRY(require_same_runs(modelled, months, design.folder, keep_going, notes));
  const MeasureColumns columns{model, measures};
  auto engine = TRY(
      make_energyplus_engine(modelled.site, model, months, columns.beside(), keep_going, notes));
  EngineWithMeasures with_measures{*engine, columns};
  const std::filesystem::path folder = measure_folder(model, measures);
  const doe::DesignPlan plan = plan_of(design, columns, engine->fingerprint());
  auto made = make_planned_runs(folder, plan, with_measures, *engine, true, executor, observer);
  if (!made) return made;
  TRY(copy_weather(design.folder, folder));
  return made;
}

}  // namespace recald::daemon
