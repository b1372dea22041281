#include "daemon/site/savings/measure_runs.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <utility>

#include "adapters/system/sha256.hpp"
#include "core/design/latin_hypercube.hpp"
#include "core/model/parameter_library.hpp"
#include "core/random/streams.hpp"
#include "daemon/site/model/energyplus_site.hpp"

namespace recald::daemon {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using savings::Change;
using savings::Measure;

constexpr std::uint64_t kSeed = 1;  // the same runs whenever they are asked for
constexpr std::size_t kNameDigits = 16;

/// What a library's quantity can be; any number for others.
double possible(const std::string& name, double value) {
  const auto definition = model::find_parameter(name);
  return definition ? std::clamp(value, (*definition)->least, (*definition)->most) : value;
}

/// EnergyPlus with measures: rows have the model's parameters and the extents that are not known.
class EngineWithMeasures final : public Engine {
 public:
  /// @param engine  Has a column for each change that is of no parameter of the model.
  EngineWithMeasures(energyplus::EnergyPlusEngine& engine, const ModelConfig& model,
                     std::vector<Change> changes)
      : engine_{engine}, parameters_{std::ssize(model.parameters)}, changes_{std::move(changes)} {
    for (const Change& change : changes_) of_.push_back(parameter_of(model, change));
  }

  Result<MatrixXd> run(const MatrixXd& theta, const ForEachIndex& executor,
                       const Observer& observer) override {
    return engine_.run(with_measures(theta), executor, observer);
  }
  [[nodiscard]] std::vector<FailedRun> failed_runs() const override {
    return engine_.failed_runs();
  }
  [[nodiscard]] bool keeps_runs() const override { return true; }

 private:
  [[nodiscard]] MatrixXd with_measures(const MatrixXd& theta) const {
    const auto& columns = engine_.targeted();
    MatrixXd rows(theta.rows(), std::ssize(columns));
    rows.leftCols(parameters_) = theta.leftCols(parameters_);
    Index own = parameters_;     // the next column of a change by itself
    Index extent = parameters_;  // the next column of an extent that is not known
    for (std::size_t c = 0; c < changes_.size(); ++c) {
      const Change& change = changes_[c];
      const Index at = of_[c] ? static_cast<Index>(*of_[c]) : own++;
      if (!of_[c]) rows.col(at).setConstant(columns[static_cast<std::size_t>(at)].design);
      const bool is_drawn = !change.by.is_certain();
      for (Index i = 0; i < rows.rows(); ++i) {
        const double by = is_drawn ? theta(i, extent) : change.by.mode;
        rows(i, at) = change.targets.empty()
                          ? possible(change.parameter, changed(change.kind, rows(i, at), by))
                          : by;
      }
      if (is_drawn) ++extent;
    }
    return rows;
  }

  energyplus::EnergyPlusEngine& engine_;
  Index parameters_;
  std::vector<Change> changes_;
  std::vector<std::optional<std::size_t>> of_;  ///< Parameter of the model, by change.
};

/// The design's months and the weather that its runs had.
Result<RunMonths> months_of_runs(const doe::DesignFolder& design) {
  RunMonths runs;
  for (const doe::DesignMonth& name : design.months) {
    const auto month = metering::parse_month(name.text());
    if (!month) return tl::unexpected(month.error());
    const int year = static_cast<int>(month->year());
    const auto file = design.folder / kWeatherYears / fmt::format("{}.epw", year);
    std::error_code ignored;
    if (!std::filesystem::exists(file, ignored)) {
      return failure(ErrorCode::not_found,
                     fmt::format("the weather of the runs is gone: {} is not there; make the runs "
                                 "again with `recald doe` into another 'design' folder",
                                 file.string()));
    }
    runs.months.push_back(*month);
    runs.weather[year] = file;
  }
  return runs;
}

Parameter extent_of(const Change& change) {
  const std::string& name = change.parameter.empty() ? change.targets.front() : change.parameter;
  return {"extent of " + name, "-", Prior{change.by.min, change.by.mode, change.by.max}};
}

/// The first runs of the design, with an extent drawn for each change that needs one.
doe::DesignPlan plan_of(const doe::DesignFolder& design, const std::vector<Change>& changes,
                        std::string fingerprint) {
  doe::DesignPlan plan{.parameters = design.parameters,
                       .theta = {},
                       .output_names = design.output_names,
                       .months = design.months,
                       .inputs = design.inputs,
                       .measurements = {design.months, design.output_names, {}},
                       .seed = kSeed,
                       .fingerprint = std::move(fingerprint)};
  plan.measurements.values.setConstant(std::ssize(design.months), std::ssize(design.output_names),
                                       kAbsent);
  std::vector<Parameter> extents;
  for (const Change& change : uncertain(changes)) extents.push_back(extent_of(change));
  const Index runs = std::min<Index>(kMeasureRuns, design.theta.rows());
  const Index q = design.theta.cols();
  plan.theta.resize(runs, q + std::ssize(extents));
  plan.theta.leftCols(q) = design.theta.topRows(runs);
  if (!extents.empty()) {
    Rng rng{kSeed, streams::kHypercube.first};
    plan.theta.rightCols(std::ssize(extents)) =
        design::latin_hypercube(extents, static_cast<int>(runs), rng);
  }
  plan.parameters.insert(plan.parameters.end(), extents.begin(), extents.end());
  return plan;
}

}  // namespace

std::vector<Change> changes_of(std::span<const Measure> measures) {
  std::vector<Change> changes;
  for (const Measure& measure : measures) {
    changes.insert(changes.end(), measure.changes.begin(), measure.changes.end());
  }
  return changes;
}

std::vector<Change> uncertain(std::vector<Change> changes) {
  std::erase_if(changes, [](const Change& change) { return change.by.is_certain(); });
  return changes;
}

std::vector<std::span<const Measure>> alone_and_together(const std::vector<Measure>& measures) {
  std::vector<std::span<const Measure>> all;
  for (std::size_t m = 0; m < measures.size(); ++m) {
    all.push_back(std::span{measures}.subspan(m, 1));
  }
  if (measures.size() > 1) all.emplace_back(measures);
  return all;
}

std::filesystem::path measure_folder(const ModelConfig& model, std::span<const Measure> measures) {
  system::Sha256 digest;
  for (const Change& change : changes_of(measures)) {
    digest.add(fmt::format("{} [{}] {} {:a} {:a} {:a}\n", change.parameter,
                           fmt::join(change.targets, " "), static_cast<int>(change.kind),
                           change.by.min, change.by.mode, change.by.max));
  }
  return model.energyplus->design / "measures" / digest.hex().substr(0, kNameDigits);
}

bool has_measure_runs(const ModelConfig& model, std::span<const Measure> measures) {
  return doe::read_design_folder(measure_folder(model, measures)).has_value();
}

Result<MadeRuns> make_measure_runs(const ModelledSite& modelled, std::span<const Measure> measures,
                                   const ForEachIndex& executor, const Engine::Observer& observer) {
  const ModelConfig& model = *modelled.site.config.model;
  auto lock = lock_runs(model.energyplus->design);
  if (!lock) return tl::unexpected(lock.error());
  const auto design = doe::read_design_folder(model.energyplus->design);
  if (!design) return tl::unexpected(design.error());
  auto months = months_of_runs(*design);
  if (!months) return tl::unexpected(months.error());
  const std::vector<Change> changes = changes_of(measures);
  std::vector<std::string> notes;
  auto engine = make_energyplus_engine(
      modelled.site, model, std::move(*months), changes,
      [&] { return !observer || observer(0, 0); }, notes);
  if (!engine) return tl::unexpected(engine.error());
  EngineWithMeasures with_measures{**engine, model, changes};
  const std::filesystem::path folder = measure_folder(model, measures);
  auto made = make_planned_runs(folder, plan_of(*design, changes, (*engine)->fingerprint()),
                                with_measures, **engine, true, executor, observer);
  if (!made) return made;
  std::error_code failed;
  std::filesystem::copy_file(design->folder / kRunsWeather, folder / kRunsWeather,
                             std::filesystem::copy_options::overwrite_existing, failed);
  if (failed) {
    return failure(
        ErrorCode::io_failed,
        fmt::format("cannot write {}: {}", (folder / kRunsWeather).string(), failed.message()));
  }
  made->notes = std::move(notes);
  return made;
}

}  // namespace recald::daemon
