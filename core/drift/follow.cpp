#include "core/drift/follow.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <functional>
#include <numeric>
#include <string>
#include <utility>

#include "core/absent.hpp"
#include "core/calibration/covariance/hyper_prior.hpp"
#include "core/calibration/posterior/emulator.hpp"
#include "core/design/model_runs.hpp"

namespace recald::drift {
namespace {

using Proceed = std::function<bool()>;

constexpr int kPathDraws = 512;
constexpr int kYear = 12;

const std::vector<Window>& windows() {
  static const std::vector<Window> all{{.name = "expanding"},
                                       {.name = "24 months", .months = 24},
                                       {.name = std::string{kLastYearWindow}, .months = 12},
                                       {.name = "forgetting", .half_life_months = 12.0}};
  return all;
}

/// What all windows of a site share.
struct Ground {
  const MonthlyModel& model;
  const std::vector<Parameter>& parameters;
  calibration::PosteriorData data;  ///< Of all months.
  std::vector<LevelOutput> levels;
  calibration::HyperPrior prior;
  const std::vector<DailyWatches::Output>& days;
  DailyWatches daily;  ///< Before the first month after the learning ones.
  AskHours ask_hours;
};

void extend(FollowedWindow& window, const SequentialCalibration& sequence) {
  if (!sequence.has_begun()) {
    for (ParameterPath& path : window.paths) {
      for (auto* values : {&path.mean, &path.q05, &path.q95}) values->push_back(kAbsent);
    }
    return;
  }
  const Eigen::MatrixXd draws = sequence.draw_parameters(kPathDraws);
  for (std::size_t j = 0; j < window.paths.size(); ++j) {
    Eigen::VectorXd sorted = draws.col(static_cast<Eigen::Index>(j));
    std::sort(sorted.begin(), sorted.end());
    const auto at = [&](double share) { return sorted(std::lround(share * (kPathDraws - 1))); };
    window.paths[j].mean.push_back(sorted.mean());
    window.paths[j].q05.push_back(at(0.05));
    window.paths[j].q95.push_back(at(0.95));
  }
}

/// Tells and asks the observer, once for all windows.
class Pace {
 public:
  Pace(const calibration::RunContext& context, int months) : context_(context), months_(months) {}

  [[nodiscard]] Proceed proceed() {
    return [this] { return goes_on(done_); };
  }
  void month_is_done() { (void)goes_on(++done_); }

 private:
  bool goes_on(int done) {
    if (stopped_ || !context_.observer) return !stopped_;
    if (!context_.observer({calibration::Progress::Stage::sampling, 0, done, months_})) {
      stopped_ = true;
    }
    return !stopped_;
  }

  const calibration::RunContext& context_;
  int months_;
  std::atomic<int> done_ = 0;  // windows may have threads of their own
  std::atomic<bool> stopped_ = false;
};

/// One window through all months. `step` takes a month in; the first ones are learnt together.
template <class Learn, class Step>
Result<FollowedWindow> follow_window(const std::string& name, const Ground& ground, int learning,
                                     const SequentialCalibration& sequence, Pace& pace, Learn learn,
                                     Step step) {
  FollowedWindow window{.name = name, .paths = {}, .taken = {}};
  window.paths.resize(ground.parameters.size());
  std::vector<int> first(static_cast<std::size_t>(learning));
  std::iota(first.begin(), first.end(), 0);
  TRY(learn(std::move(first)));
  extend(window, sequence);
  const auto months = static_cast<int>(ground.data.month_inputs.rows());
  for (int month = learning; month < months; ++month) {
    const Result<MonthTaken> taken = step(month);
    if (!taken) return tl::unexpected(taken.error());
    window.log_score += taken->log_score;
    window.taken.push_back(*taken);
    extend(window, sequence);
    pace.month_is_done();
  }
  return window;
}

/// Parameters from the year before the last to the last, from windows that share no month.
std::vector<Shift> shift_of_last_year(const Eigen::MatrixXd& then, const Eigen::MatrixXd& now,
                                      const std::vector<Parameter>& parameters) {
  std::vector<Shift> shifts;
  for (Eigen::Index j = 0; j < now.cols() && then.rows() > 1; ++j) {
    shifts.push_back(shift_between(then.col(j), now.col(j),
                                   parameters[static_cast<std::size_t>(j)].prior.variance()));
  }
  return shifts;
}

SequentialCalibration sequence_of(const Ground& ground, const Window& window,
                                  const FollowOptions& options, std::uint64_t seed) {
  return {ground.model, ground.parameters,  ground.data, ground.prior,
          window,       options.sequential, seed};
}

/// What the alarms of each meter whose days are known have added.
void add_excesses(const std::vector<DailyWatches::Output>& meters, SiteDrift& drift) {
  for (const DailyWatches::Output& meter : meters) {
    std::vector<ExplainedAlarm*> alarms;
    std::vector<NoticedChange> changes;
    for (ExplainedAlarm& one : drift.alarms) {
      if (one.alarm.output != meter.output) continue;
      const auto month = metering::parse_month(drift.month_name(one.alarm.since));
      if (!one.alarm.days && !month) continue;
      alarms.push_back(&one);
      changes.push_back({one.alarm.days ? one.alarm.days->since : *month / 1, one.alarm.direction});
    }
    const auto excesses = excesses_of(meter.days, changes);
    for (std::size_t i = 0; i < alarms.size(); ++i) alarms[i]->excess = excesses[i];
  }
}

/// Makes the record, too.
Result<FollowedWindow> follow_expanding(const Ground& ground, const FollowOptions& options,
                                        std::uint64_t seed, Pace& pace, SiteDrift& drift) {
  const Proceed proceed = pace.proceed();
  DailyWatches daily = ground.daily;
  WatchOptions monthly = options.watch;
  if (daily.is_able()) monthly.months_between_false_alarms *= 2.0;  // days have the other half
  Prequential prequential{sequence_of(ground, windows().front(), options, seed), ground.data,
                          ground.levels, monthly};
  Inquiries inquiries{ground.model, ground.prior, options.inquiries, seed,   drift,
                      prequential,  daily,        ground.ask_hours,  proceed};
  auto window = follow_window(
      windows().front().name, ground, drift.learning_months, prequential.calibration(), pace,
      [&](std::vector<int> first) { return prequential.learn(std::move(first), proceed); },
      [&](int month) -> Result<MonthTaken> {
        auto one = TRY(prequential.step(month, proceed));
        drift.record.push_back(std::move(one));
        TRY(inquiries.evaluate(drift.record.back()));
        return drift.record.back().taken;
      });
  for (std::size_t k = 0; k < drift.outputs.size(); ++k) {
    drift.outputs[k].state = prequential.watch().state(static_cast<int>(k));
    drift.outputs[k].daily = daily.state(static_cast<int>(k));
  }
  add_excesses(ground.days, drift);
  return window;
}

Result<FollowedWindow> follow_beside(const Ground& ground, const Window& which,
                                     const FollowOptions& options, std::uint64_t seed, Pace& pace,
                                     SiteDrift& drift) {
  const Proceed proceed = pace.proceed();
  SequentialCalibration sequence = sequence_of(ground, which, options, seed);
  const auto months = static_cast<int>(drift.months.size());
  Eigen::MatrixXd then;
  auto window = follow_window(
      which.name, ground, drift.learning_months, sequence, pace,
      [&](std::vector<int> first) { return sequence.learn(std::move(first), proceed); },
      [&](int month) {
        auto taken = sequence.take(month, proceed);
        const bool is_year_before = which.months == kYear && month + 1 == months - kYear;
        if (taken && is_year_before && sequence.has_begun()) {
          then = sequence.draw_parameters(kPathDraws);
        }
        return taken;
      });
  if (which.months == kYear && sequence.has_begun()) {
    drift.last_year =
        shift_of_last_year(then, sequence.draw_parameters(kPathDraws), drift.parameters);
  }
  return window;
}

/// Windows beside each other, each by itself.
Result<void> follow_all(const Ground& ground, const FollowOptions& options,
                        const calibration::RunContext& context, SiteDrift& drift) {
  const std::size_t count = windows().size();
  const auto months = drift.months.size() - static_cast<std::size_t>(drift.learning_months);
  Pace pace{context, static_cast<int>(count * months)};
  std::vector<Result<FollowedWindow>> done(count, FollowedWindow{});
  context.executor(count, [&](std::size_t i) {
    done[i] = i == 0 ? follow_expanding(ground, options, context.seed, pace, drift)
                     : follow_beside(ground, windows()[i], options, context.seed, pace, drift);
  });
  for (Result<FollowedWindow>& window : done) {
    if (!window) return tl::unexpected(window.error());
    drift.windows.push_back(std::move(*window));
  }
  return {};
}

bool has_figures_after(const Ground& ground, int learning) {
  const auto has_level = [&](const LevelOutput& level) {
    return std::any_of(level.measured.begin() + learning, level.measured.end(),
                       [](double value) { return !std::isnan(value); });
  };
  return std::ranges::any_of(ground.levels, has_level) ||
         std::ranges::any_of(ground.data.points,
                             [&](const auto& point) { return point.month >= learning; });
}

SiteDrift drift_of(const FollowedSite& followed, SeenBeside& beside) {
  const assessment::AssessedCalibration& site = followed.site;
  SiteDrift drift{.model = site.model,
                  .units = site.units,
                  .months = site.month_names,
                  .learning_months = followed.learning_months,
                  .parameters = site.parameters,
                  .outputs = {},
                  .record = {},
                  .alarms = {},
                  .meter_changes = std::move(beside.meter_changes),
                  .directions = std::move(beside.directions),
                  .windows = {},
                  .last_year = {},
                  .warnings = site.warnings};
  for (const assessment::OutputCalibration& output : site.outputs) {
    drift.outputs.push_back({.name = output.name,
                             .meter = output.meter_id,
                             .unit = output.unit,
                             .utility = output.utility,
                             .by_level = !output.calibrated,
                             .measured = output.measured,
                             .state = {}});
  }
  return drift;
}

}  // namespace

Result<SiteDrift> follow(const FollowedSite& followed,
                         const calibration::CalibrationProblem& learning,
                         const calibration::DesignRuns& design, SeenBeside beside,
                         const FollowOptions& options, const calibration::RunContext& context) {
  const auto normalisation = TRY(
      calibration::normalise_design(design.outputs, learning.outputs, followed.learning_months));

  // A posterior that is carried on is evaluated a million times.
  const auto runs = TRY(design::run_model(followed.model, followed.site.parameters, design.theta,
                                          context.executor, calibration::of_runs(context)));
  const auto emulator = TRY(calibration::emulate(design.theta, runs, followed.model.output_count(),
                                                 followed.model.month_count()));

  const bool is_calibrated =
      std::ranges::any_of(followed.site.outputs, &assessment::OutputCalibration::calibrated);
  SiteDrift drift = drift_of(followed, beside);
  const Ground ground{
      emulator.model,
      followed.site.parameters,
      data_of_all(followed, normalisation, emulator.error_sd),
      levels_of(followed),
      calibration::make_hyper_prior(calibration::HyperPriorProfile::scaled,
                                    is_calibrated ? normalisation.pooled_variance : 1.0),
      // Days and months share the false alarms.
      beside.days,
      {beside.days, drift.months, drift.learning_months,
       2.0 * options.watch.months_between_false_alarms},
      std::move(beside.ask_hours)};
  if (!has_figures_after(ground, drift.learning_months)) {
    drift.warnings.push_back({"No month after the learning period has a figure to compare."});
  }
  TRY(follow_all(ground, options, context, drift));
  return drift;
}

}  // namespace recald::drift
