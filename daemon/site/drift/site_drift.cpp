#include "daemon/site/drift/site_drift.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <mutex>
#include <numeric>
#include <utility>

#include "core/absent.hpp"
#include "core/calibration/hyper_prior.hpp"
#include "core/calibration/problem.hpp"
#include "core/drift/emulator.hpp"
#include "core/metering/lost_readings.hpp"
#include "daemon/site/drift/watched_days.hpp"

namespace recald::daemon {
namespace {

using drift::Prequential;
using drift::SequentialCalibration;
using metering::Month;
using metering::MonthRange;
using Proceed = std::function<bool()>;

constexpr int kPathDraws = 512;
constexpr int kYear = 12;
constexpr int kSameTime = 2;  // months between a change and what is seen of a meter
constexpr int kMonthsToKnowAUnit = 6;

const std::vector<drift::Window>& windows() {
  static const std::vector<drift::Window> all{{.name = "expanding"},
                                              {.name = "24 months", .months = 24},
                                              {.name = std::string{kLastYearWindow}, .months = 12},
                                              {.name = "forgetting", .half_life_months = 12.0}};
  return all;
}

/// What all windows of a site share.
struct Followed {
  const MonthlyModel& model;
  const std::vector<Parameter>& parameters;
  calibration::PosteriorData data;  ///< Of all months.
  std::vector<drift::LevelOutput> levels;
  calibration::HyperPrior prior;
  std::vector<drift::Direction> directions;
  DailyWatches daily;  ///< Before the first month after the learning ones.
};

/// Each column by its range over the first `learning` months: later ones must not change what was
/// said of earlier ones, so they may leave [0, 1].
Eigen::MatrixXd scaled_by_first(const Eigen::MatrixXd& values, Eigen::Index learning) {
  Eigen::MatrixXd scaled = values;
  for (Eigen::Index j = 0; j < values.cols(); ++j) {
    const auto first = values.col(j).head(learning);
    const double low = first.minCoeff();
    scaled.col(j) = (values.col(j).array() - low) / (first.maxCoeff() - low);
  }
  return scaled;
}

/// What is known of each point's error, as the mean over the outputs of its month: then the
/// covariance comes apart by outputs, and its factor, of which a sequence takes a million, costs a
/// tenth. The known part (filled gaps, the emulator) is small beside what is learnt.
void share_by_month(calibration::PosteriorData& data) {
  Eigen::VectorXd sums = Eigen::VectorXd::Zero(data.month_inputs.rows());
  Eigen::VectorXd counts = sums;
  for (std::size_t i = 0; i < data.points.size(); ++i) {
    sums(data.points[i].month) += data.extra_variances(static_cast<Eigen::Index>(i));
    counts(data.points[i].month) += 1.0;
  }
  for (std::size_t i = 0; i < data.points.size(); ++i) {
    const int month = data.points[i].month;
    data.extra_variances(static_cast<Eigen::Index>(i)) = sums(month) / counts(month);
  }
}

/// All months on the scale that the learning months' design gives.
calibration::PosteriorData data_of_all(const PreparedSite& prepared,
                                       const calibration::Normalisation& normalisation,
                                       const Eigen::VectorXd& error_sd) {
  const SiteCalibration& site = prepared.so_far;
  calibration::CalibrationProblem all = problem_of(site, site.month_names.size());
  for (std::size_t k = 0; k < all.outputs.size(); ++k) {
    if (!site.outputs[k].calibrated) std::ranges::fill(all.outputs[k].values, kAbsent);
  }
  all.inputs = {prepared.inputs.names, prepared.inputs.values};
  all.common_errors = prepared.common_errors;
  calibration::PosteriorData data = calibration::normalise_problem(all, normalisation);
  data.month_inputs = scaled_by_first(prepared.inputs.values, prepared.model->month_count());
  const auto months = static_cast<Eigen::Index>(site.month_names.size());
  for (std::size_t i = 0; i < data.points.size(); ++i) {
    const auto& [output, month] = data.points[i];
    const double sd = error_sd(output * months + month);
    data.extra_variances(static_cast<Eigen::Index>(i)) +=
        data.scales[static_cast<std::size_t>(output)].normalise_variance(sd * sd);
  }
  share_by_month(data);
  return data;
}

std::vector<drift::LevelOutput> levels_of(const PreparedSite& prepared) {
  const SiteCalibration& site = prepared.so_far;
  const std::vector<double> modelled =
      evaluate(*prepared.whole_model, prior_modes(site.parameters));
  const auto months = static_cast<std::ptrdiff_t>(site.month_names.size());
  std::vector<drift::LevelOutput> levels;
  for (std::size_t k = 0; k < site.outputs.size(); ++k) {
    if (site.outputs[k].calibrated) continue;
    const auto first = modelled.begin() + static_cast<std::ptrdiff_t>(k) * months;
    if (std::any_of(first, first + months, [](double value) { return !(value > 0.0); })) continue;
    levels.push_back({static_cast<int>(k), {first, first + months}, site.outputs[k].measured});
  }
  return levels;
}

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

/// Tells and asks the observer, who does not expect that windows have threads of their own.
class Pace {
 public:
  Pace(const calibration::RunContext& context, int months) : context_(context), months_(months) {}

  [[nodiscard]] std::function<bool()> proceed() {
    return [this] { return goes_on(0); };
  }
  void month_is_done() { (void)goes_on(1); }

 private:
  bool goes_on(int more) {
    const std::lock_guard lock{asking_};
    done_ += more;
    if (stopped_ || !context_.observer) return !stopped_;
    stopped_ = !context_.observer({calibration::Progress::Stage::sampling, 0, done_, months_});
    return !stopped_;
  }

  const calibration::RunContext& context_;
  int months_;
  std::mutex asking_;
  int done_ = 0;
  bool stopped_ = false;
};

/// One window through all months. `step` takes a month in; the first ones are learnt together.
template <class Learn, class Step>
Result<FollowedWindow> follow(const std::string& name, const Followed& followed, int learning,
                              const SequentialCalibration& sequence, Pace& pace, Learn learn,
                              Step step) {
  FollowedWindow window{.name = name, .paths = {}, .taken = {}};
  window.paths.resize(followed.parameters.size());
  std::vector<int> first(static_cast<std::size_t>(learning));
  std::iota(first.begin(), first.end(), 0);
  if (const auto learnt = learn(std::move(first)); !learnt) {
    return tl::unexpected(learnt.error());
  }
  extend(window, sequence);
  const auto months = static_cast<int>(followed.data.month_inputs.rows());
  for (int month = learning; month < months; ++month) {
    const Result<drift::MonthTaken> taken = step(month);
    if (!taken) return tl::unexpected(taken.error());
    window.log_score += taken->log_score;
    window.taken.push_back(*taken);
    extend(window, sequence);
    pace.month_is_done();
  }
  return window;
}

/// Parameters from the year before the last to the last, from windows that share no month.
std::vector<drift::Shift> shift_of_last_year(const Eigen::MatrixXd& then,
                                             const Eigen::MatrixXd& now,
                                             const std::vector<Parameter>& parameters) {
  std::vector<drift::Shift> shifts;
  for (Eigen::Index j = 0; j < now.cols() && then.rows() > 1; ++j) {
    shifts.push_back(drift::shift_between(
        then.col(j), now.col(j), parameters[static_cast<std::size_t>(j)].prior.variance()));
  }
  return shifts;
}

SequentialCalibration sequence_of(const Followed& followed, const drift::Window& window,
                                  const DriftOptions& options, std::uint64_t seed) {
  return {followed.model, followed.parameters, followed.data, followed.prior,
          window,         options.sequential,  seed};
}

/// The first month that the record's model still believes.
int began_at(const SiteDrift& drift) {
  int month = 0;
  for (const ExplainedAlarm& one : drift.alarms) {
    if (one.consequence == ExplainedAlarm::Consequence::began_anew) month = one.alarm.since;
  }
  return month;
}

/// Days that are so far off what was expected may be in another unit, which takes months to tell
/// from a plant that stands still.
bool could_be_a_unit(const drift::Alarm& alarm) {
  constexpr double least_factor = 8.0;
  if (!alarm.days) return false;
  const double ratio = 1.0 + alarm.days->excess;
  return ratio >= least_factor || ratio <= 1.0 / least_factor;
}

/// Alarms of a record, from the month that raises one until it is known what it comes from.
class Inquiries {
 public:
  Inquiries(const Followed& followed, const DriftOptions& options, std::uint64_t seed,
            SiteDrift& drift, Prequential& prequential, DailyWatches& daily, const Proceed& proceed)
      : followed_(followed),
        options_(options),
        seed_(seed),
        drift_(drift),
        prequential_(prequential),
        daily_(daily),
        proceed_(proceed) {}

  /// After a month was taken in. Days say first when something changed.
  Result<void> look(const drift::PrequentialMonth& month) {
    for (const drift::Alarm& alarm : daily_.look(month.month)) {
      if (auto opened = open(alarm, month.month); !opened) return opened;
    }
    for (const drift::Alarm& alarm : month.alarms) {
      if (auto opened = open(alarm, month.month); !opened) return opened;
    }
    for (std::size_t i = 0; i < open_.size();) {
      const auto is_over = weigh(open_[i], month.month);
      if (!is_over) return tl::unexpected(is_over.error());
      if (drift_.alarms[open_[i].alarm].consequence != ExplainedAlarm::Consequence::none) {
        // What was believed before has changed: the others are asked anew if they go on.
        open_.clear();
      } else if (*is_over) {
        open_.erase(open_.begin() + static_cast<std::ptrdiff_t>(i));
      } else {
        ++i;
      }
    }
    return {};
  }

 private:
  struct Open {
    std::size_t alarm;
    std::vector<Eigen::VectorXd> before;
  };

  Result<void> open(const drift::Alarm& alarm, int month) {
    if (is_known(alarm)) return {};
    auto before = drift::known_before(case_of(alarm, month), options_.causes, seed_, proceed_);
    if (!before && before.error().code != ErrorCode::not_enough_data) {
      return tl::unexpected(before.error());
    }
    drift_.alarms.push_back({.alarm = alarm, .causes = {}, .explained_until = month});
    if (before) open_.push_back({drift_.alarms.size() - 1, std::move(*before)});
    return {};
  }

  /// The same output's alarm is still being looked into, or was raised by this month's days: it is
  /// one change, not two.
  [[nodiscard]] bool is_known(const drift::Alarm& alarm) const {
    const auto is_same = [&](const ExplainedAlarm& one) {
      return one.alarm.output == alarm.output;
    };
    return std::ranges::any_of(
               open_, [&](const Open& one) { return is_same(drift_.alarms[one.alarm]); }) ||
           std::ranges::any_of(drift_.alarms, [&](const ExplainedAlarm& one) {
             return is_same(one) && one.alarm.month == alarm.month;
           });
  }

  [[nodiscard]] drift::ChangeCase case_of(const drift::Alarm& alarm, int until) const {
    return {.model = followed_.model,
            .parameters = followed_.parameters,
            .data = prequential_.data(),
            .prior = followed_.prior,
            .levels = prequential_.levels(),
            .directions = followed_.directions,
            .learning_months = drift_.learning_months,
            .first = began_at(drift_),
            .since = alarm.since,
            .until = until};
  }

  /// That the alarm's meter began to lose readings or changed its unit about then, as far as is
  /// known after `month`; null: nothing is known.
  [[nodiscard]] const MeterChange* change_of_meter(const drift::Alarm& alarm, int month) const {
    const auto& meter = drift_.outputs[static_cast<std::size_t>(alarm.output)].meter;
    const auto found = std::ranges::find_if(drift_.meter_changes, [&](const MeterChange& change) {
      if (change.meter != meter) return false;
      const auto since = std::ranges::lower_bound(drift_.months, change.since);
      const auto off = (since - drift_.months.begin()) - alarm.since;
      return change.seen <= drift_.month_name(month) && std::abs(off) <= kSameTime;
    });
    return found == drift_.meter_changes.end() ? nullptr : &*found;
  }

  /// A meter that is known to have changed explains whatever it alone shows, even or uneven.
  static void blame_meter(ExplainedAlarm& alarm, const MeterChange& change) {
    const auto of_output = [&](drift::CauseKind kind) {
      return std::ranges::find_if(alarm.causes, [&](const drift::Cause& cause) {
        return cause.kind == kind && cause.index == alarm.alarm.output;
      });
    };
    const auto meter = of_output(drift::CauseKind::meter);
    const auto alone = of_output(drift::CauseKind::unknown);
    if (meter == alarm.causes.end() || alone == alarm.causes.end()) return;
    meter->probability += alone->probability;
    alone->probability = 0.0;
    // The refit seeks no factor as far off as a unit's.
    if (change.kind == MeterChange::Kind::unit) {
      meter->mean = meter->q05 = meter->q95 = change.factor;
    }
    std::ranges::stable_sort(alarm.causes, std::ranges::greater{}, &drift::Cause::probability);
  }

  /// @return whether nothing more is to be asked.
  Result<bool> weigh(const Open& open, int month) {
    ExplainedAlarm& alarm = drift_.alarms[open.alarm];
    auto causes =
        drift::weigh_causes(case_of(alarm.alarm, month), open.before, options_.causes, seed_);
    if (!causes) return tl::unexpected(causes.error());
    alarm.causes = std::move(*causes);
    const MeterChange* change = change_of_meter(alarm.alarm, month);
    if (change) blame_meter(alarm, *change);
    alarm.explained_until = month;
    const int months = month - alarm.alarm.since + 1;
    const int months_to_act = could_be_a_unit(alarm.alarm) && !change
                                  ? std::max(options_.months_to_act, kMonthsToKnowAUnit)
                                  : options_.months_to_act;
    const drift::Cause& first = alarm.causes.front();
    if (months < months_to_act || first.probability < options_.act_at) {
      return months >= kYear;
    }
    Result<void> done;
    if (first.kind == drift::CauseKind::meter) {
      done = prequential_.set_aside(first.index, alarm.alarm.since, proceed_);
      daily_.set_aside(first.index);
      alarm.consequence = ExplainedAlarm::Consequence::meter_set_aside;
    } else if (first.kind != drift::CauseKind::nothing) {
      done = prequential_.begin_at(alarm.alarm.since, proceed_);
      daily_.begin_at(alarm.alarm.since);
      alarm.consequence = ExplainedAlarm::Consequence::began_anew;
    }
    if (!done) return tl::unexpected(done.error());
    return true;
  }

  const Followed& followed_;
  const DriftOptions& options_;
  std::uint64_t seed_;
  SiteDrift& drift_;
  Prequential& prequential_;
  DailyWatches& daily_;
  const Proceed& proceed_;
  std::vector<Open> open_;
};

/// Makes the record, too.
Result<FollowedWindow> follow_expanding(const Followed& followed, const DriftOptions& options,
                                        std::uint64_t seed, Pace& pace, SiteDrift& drift) {
  const Proceed proceed = pace.proceed();
  DailyWatches daily = followed.daily;
  drift::WatchOptions monthly = options.watch;
  if (daily.is_able()) monthly.months_between_false_alarms *= 2.0;  // days have the other half
  Prequential prequential{sequence_of(followed, windows().front(), options, seed), followed.data,
                          followed.levels, monthly};
  Inquiries inquiries{followed, options, seed, drift, prequential, daily, proceed};
  auto window = follow(
      windows().front().name, followed, drift.learning_months, prequential.calibration(), pace,
      [&](std::vector<int> first) { return prequential.learn(std::move(first), proceed); },
      [&](int month) -> Result<drift::MonthTaken> {
        auto one = prequential.step(month, proceed);
        if (!one) return tl::unexpected(one.error());
        drift.record.push_back(std::move(*one));
        if (auto looked = inquiries.look(drift.record.back()); !looked) {
          return tl::unexpected(looked.error());
        }
        return drift.record.back().taken;
      });
  for (std::size_t k = 0; k < drift.outputs.size(); ++k) {
    drift.outputs[k].state = prequential.watch().state(static_cast<int>(k));
    drift.outputs[k].daily = daily.state(static_cast<int>(k));
  }
  return window;
}

Result<FollowedWindow> follow_beside(const Followed& followed, const drift::Window& which,
                                     const DriftOptions& options, std::uint64_t seed, Pace& pace,
                                     SiteDrift& drift) {
  const Proceed proceed = pace.proceed();
  SequentialCalibration sequence = sequence_of(followed, which, options, seed);
  const auto months = static_cast<int>(drift.months.size());
  Eigen::MatrixXd then;
  auto window = follow(
      which.name, followed, drift.learning_months, sequence, pace,
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
Result<void> follow_all(const Followed& followed, const DriftOptions& options,
                        const calibration::RunContext& context, SiteDrift& drift) {
  const std::size_t count = windows().size();
  const auto months = drift.months.size() - static_cast<std::size_t>(drift.learning_months);
  Pace pace{context, static_cast<int>(count * months)};
  std::vector<Result<FollowedWindow>> done(count, FollowedWindow{});
  context.executor(count, [&](std::size_t i) {
    done[i] = i == 0 ? follow_expanding(followed, options, context.seed, pace, drift)
                     : follow_beside(followed, windows()[i], options, context.seed, pace, drift);
  });
  for (Result<FollowedWindow>& window : done) {
    if (!window) return tl::unexpected(window.error());
    drift.windows.push_back(std::move(*window));
  }
  return {};
}

std::string lost_words(const std::string& meter, const metering::LostReadings& lost) {
  return fmt::format(
      "{} gives usable readings for {:.0f} % of the time since {}, {:.0f} % before{}; "
      "seen after {}",
      meter, 100.0 * lost.share_since, metering::to_string(lost.since), 100.0 * lost.share_before,
      lost.stands_still ? ": it stands still at one value" : "", metering::to_string(lost.seen));
}

/// @param first  Month that the record begins with.
std::vector<MeterChange> meter_changes_of(const Recording& recording, const std::string& first,
                                          int learning_months) {
  std::vector<MeterChange> changes;
  for (const MeterRecord& record : recording.meters) {
    const std::string& id = record.meter.id;
    for (const metering::LevelChange& change : record.level_changes) {
      if (change.kind != metering::LevelChangeKind::scale) continue;
      const std::string since = metering::to_string(change.since);
      changes.push_back({MeterChange::Kind::unit, id, since, since, change.factor, change.words});
    }
    const auto begin = std::ranges::find(record.figures, first, [](const auto& figure) {
      return metering::to_string(figure.month);
    });
    const auto lost = metering::find_lost_readings({begin, record.figures.end()},
                                                   static_cast<std::size_t>(learning_months));
    if (!lost) continue;
    changes.push_back({MeterChange::Kind::readings, id, metering::to_string(lost->since),
                       metering::to_string(lost->seen), lost->share_since / lost->share_before,
                       lost_words(id, *lost)});
  }
  return changes;
}

SiteDrift drift_of(const PreparedSite& prepared, const Recording& recording) {
  const SiteCalibration& site = prepared.so_far;
  SiteDrift drift{.model = site.model,
                  .months = site.month_names,
                  .learning_months = prepared.model->month_count(),
                  .parameters = site.parameters,
                  .outputs = {},
                  .record = {},
                  .alarms = {},
                  .meter_changes = meter_changes_of(recording, site.month_names.front(),
                                                    prepared.model->month_count()),
                  .directions = {},
                  .windows = {},
                  .last_year = {},
                  .warnings = site.warnings};
  for (const assessment::OutputCalibration& output : site.outputs) {
    drift.outputs.push_back({.name = output.name,
                             .meter = output.label,
                             .unit = output.unit,
                             .by_level = !output.calibrated,
                             .measured = output.measured,
                             .state = {}});
  }
  return drift;
}

/// Meters whose days are watched, ready to look; none and a warning where they cannot be.
DailyWatches daily_watches(const ModelledSite& modelled, double months_between_false_alarms,
                           SiteDrift& drift) {
  std::vector<FollowedMeter> meters;
  std::vector<int> outputs;
  for (std::size_t k = 0; k < drift.outputs.size(); ++k) {
    const FollowedOutput& output = drift.outputs[k];
    if (output.name != output.meter + "_daily_kWh") continue;
    meters.push_back({output.meter, output.measured});
    outputs.push_back(static_cast<int>(k));
  }
  std::vector<DailyWatches::Output> watched;
  if (auto days = watched_days(modelled, meters, drift.months, drift.learning_months); !days) {
    drift.warnings.push_back("Days are not watched: " + days.error().message + ".");
  } else {
    for (std::size_t k = 0; k < meters.size(); ++k) {
      watched.push_back({outputs[k], std::move((*days)[k])});
    }
  }
  return {std::move(watched), drift.months, drift.learning_months, months_between_false_alarms};
}

bool has_figures_after(const Followed& followed, int learning) {
  const auto has_level = [&](const drift::LevelOutput& level) {
    return std::any_of(level.measured.begin() + learning, level.measured.end(),
                       [](double value) { return !std::isnan(value); });
  };
  return std::ranges::any_of(followed.levels, has_level) ||
         std::ranges::any_of(followed.data.points,
                             [&](const auto& point) { return point.month >= learning; });
}

}  // namespace

Result<PeriodConfig> followed_period(const OpenSite& site, const Recording& recording,
                                     metering::Instant now, int learning_months) {
  std::optional<MonthRange> common;
  const auto is_followed = [&](const metering::MonthlyFigure& figure) {
    const auto end = site.calendar.month_span(figure.month).end;
    return figure.usable && end + site.config.closing.watermark <= now;
  };
  for (const std::string& id : site.config.model->outputs) {
    const MeterRecord& record = recording.meters[*site.config.meter_index(id)];
    for (const metering::MonthlyFigure& figure : record.figures) {
      if (!is_followed(figure)) continue;
      if (!common) common = MonthRange{figure.month, figure.month};
      common->last = std::max(common->last, figure.month);
    }
    const auto first = std::ranges::find_if(record.figures, is_followed);
    if (first == record.figures.end()) {
      return failure(ErrorCode::not_enough_data,
                     fmt::format("meter '{}' has no usable month yet", id));
    }
    common->first = std::max(common->first, first->month);
  }
  const auto needed = learning_months + 1;
  if (!common || common->first + std::chrono::months{needed - 1} > common->last) {
    return failure(ErrorCode::not_enough_data,
                   fmt::format("to follow a site takes {} months of all modelled meters: {} to "
                               "learn from and one to forecast",
                               needed, learning_months));
  }
  const Month last_learnt = common->first + std::chrono::months{learning_months - 1};
  return PeriodConfig{MonthRange{common->first, last_learnt},
                      MonthRange{last_learnt + std::chrono::months{1}, common->last}};
}

Result<SiteDrift> follow_site(const ModelledSite& modelled, const DriftOptions& options,
                              std::vector<diagnosis::AddedEffect> added,
                              const calibration::RunContext& context) {
  auto prepared = prepare_site(modelled.site.config, modelled.site.calendar, modelled.recording,
                               modelled.weather, std::move(added));
  if (!prepared) return tl::unexpected(prepared.error());
  auto design =
      calibration::run_design(*prepared->model, prepared->problem, options.design_runs, context);
  if (!design) return tl::unexpected(design.error());
  assessment::set_aside_unresponsive(*design, prepared->so_far, prepared->problem);
  // Outputs that no parameter moves are followed by their own level, even if all are such.
  const bool is_calibrated =
      std::ranges::any_of(prepared->so_far.outputs, &assessment::OutputCalibration::calibrated);
  if (auto ok = check_problem(prepared->problem, *prepared->model); is_calibrated && !ok) {
    return tl::unexpected(ok.error());
  }
  const auto normalisation = calibration::normalise_design(
      design->outputs, prepared->problem.outputs, prepared->model->month_count());
  if (!normalisation) return tl::unexpected(normalisation.error());

  // A posterior that is carried on is evaluated a million times.
  const auto emulator = drift::emulate(*prepared->whole_model, prepared->so_far.parameters,
                                       design->theta, context.executor);
  if (!emulator) return tl::unexpected(emulator.error());

  SiteDrift drift = drift_of(*prepared, modelled.recording);
  const Followed followed{
      emulator->model,
      prepared->so_far.parameters,
      data_of_all(*prepared, *normalisation, emulator->error_sd),
      levels_of(*prepared),
      calibration::make_hyper_prior(calibration::HyperPriorProfile::scaled,
                                    is_calibrated ? normalisation->pooled_variance : 1.0),
      {{.name = "electricity use", .change = prepared->electricity_use}},
      daily_watches(modelled, 2.0 * options.watch.months_between_false_alarms, drift)};
  drift.directions = followed.directions;
  if (!has_figures_after(followed, drift.learning_months)) {
    drift.warnings.emplace_back("No month after the learning ones has a figure to compare.");
  }
  if (auto done = follow_all(followed, options, context, drift); !done) {
    return tl::unexpected(done.error());
  }
  return drift;
}

}  // namespace recald::daemon
