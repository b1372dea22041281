#include "core/metering/months/level_change.hpp"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <cstdio>
#include <map>
#include <utility>

namespace recald::metering {
namespace {

constexpr std::size_t kReferenceYears = 3;
constexpr std::size_t kStepMonths = 3;
constexpr double kBeyondWeather = 2.0;  // times the largest month ever
constexpr std::chrono::months kRowWithin{6};

double median_log_ratio(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

std::string text(const char* format, double a, double b) {
  std::array<char, 160> buffer{};
  std::snprintf(buffer.data(), buffer.size(), format, a, b);
  return buffer.data();
}

/// "1/29" or "29" times.
std::string factor_in_words(double factor) {
  return factor < 1.0 ? "1/" + text("%.3g of", 1.0 / factor, 0.0) : text("%.3g times", factor, 0.0);
}

/// One pass over a meter's months.
class LevelWatch {
 public:
  LevelWatch(std::string_view meter_name, const LevelChangeOptions& options)
      : meter_name_{meter_name}, options_{options} {}

  void see(const MonthlyFigure& figure) {
    if (!figure.usable || !(figure.daily_average_kWh > 0.0)) return;
    const double level = std::log(figure.daily_average_kWh);
    const std::optional<double> reference = reference_for(figure.month);
    if (reference && !is_small(level, *reference)) {
      evaluate({&figure, level, level - *reference});
    } else if (!open_ && stepped_.empty()) {
      accept_level(figure.month, level);
    }
  }

  [[nodiscard]] std::vector<LevelChange> take() {
    give_up_step();  // The newest month may be the odd one.
    return std::move(changes_);
  }

 private:
  /// A month that can be compared with others.
  struct Compared {
    const MonthlyFigure* figure;
    double level;
    double log_ratio;
    double z = 0.0;
    double step = 0.0;
  };

  static unsigned month_number(Month month) { return static_cast<unsigned>(month.month()); }

  void accept_level(Month month, double level) {
    undisputed_[month_number(month)].push_back(level);
    largest_level_ = std::max(largest_level_, level);
  }

  [[nodiscard]] std::optional<double> reference_for(Month month) const {
    const auto found = undisputed_.find(month_number(month));
    if (found == undisputed_.end()) return {};
    const std::vector<double>& levels = found->second;
    const std::size_t n = std::min(levels.size(), kReferenceYears);
    double sum = 0.0;
    for (std::size_t i = levels.size() - n; i < levels.size(); ++i) sum += levels[i];
    return sum / static_cast<double>(n);
  }

  /// A heating meter's July may be a tenth of last year's or ten times as much, and mean nothing.
  [[nodiscard]] bool is_small(double level, double reference) const {
    return std::max(level, reference) < largest_level_ + std::log(options_.small_month);
  }

  struct Scatter {
    double centre;
    double scale;
  };
  [[nodiscard]] Scatter scatter() const {
    const double n0 = options_.typical_scatter_months;
    const auto n = static_cast<double>(learned_.size());
    const double centre = learned_.empty() ? 0.0 : median_log_ratio(learned_) * n / (n + n0);
    double squares = n0 * options_.typical_scatter * options_.typical_scatter;
    for (const double r : learned_) squares += (r - centre) * (r - centre);
    return {centre, std::sqrt(squares / (n0 + n))};
  }

  void evaluate(Compared month) {
    const Scatter expected = scatter();
    month.z = (month.log_ratio - expected.centre) / expected.scale;
    month.step = recent_.empty() ? month.log_ratio : month.log_ratio - median_log_ratio(recent_);
    if (std::abs(month.step) > std::log(options_.scale_factor_min)) {
      evaluate_step(month, expected.scale);
    } else {
      give_up_step();
      if (!open_) watch(month);
      remember(month.log_ratio);
    }
    if (open_) count_return(month.figure->month, std::abs(month.z) <= options_.z_max / 2.0);
  }

  void remember(double log_ratio) {
    recent_.push_back(log_ratio);
    if (recent_.size() > kStepMonths) recent_.erase(recent_.begin());
  }

  /// A month a whole factor off. Where one such month may be the weather, it waits for another.
  void evaluate_step(const Compared& month, double scale) {
    if (!stepped_.empty()) {
      const Compared& last = stepped_.back();
      const bool is_same_side = (last.step > 0.0) == (month.step > 0.0);
      const auto apart = month.figure->month - last.figure->month;
      if (!is_same_side || apart > kRowWithin) give_up_step();
    }
    stepped_.push_back(month);
    const bool is_beyond_weather = month.level > largest_level_ + std::log(kBeyondWeather);
    if (static_cast<int>(stepped_.size()) < options_.scale_months && !is_beyond_weather) return;
    const std::vector<Compared> row = std::exchange(stepped_, {});
    open(LevelChangeKind::scale, row.front(), row.front().step / scale, month.figure->month);
    recent_.clear();  // report the step only once
    for (const Compared& each : row) remember(each.log_ratio);
  }

  /// No unit, but still a month unlike others.
  void give_up_step() {
    const std::vector<Compared> alone = std::exchange(stepped_, {});
    for (const Compared& month : alone) {
      if (!open_) watch(month);
      remember(month.log_ratio);
    }
  }

  /// No change is open: one month far off, or several in a row off to the same side, opens one.
  void watch(const Compared& month) {
    const bool changed = std::abs(std::expm1(month.log_ratio)) > options_.ratio_change_min;
    const bool same_side = doubted_.empty() || (doubted_.back().z > 0.0) == (month.z > 0.0);
    const bool doubtful = changed && std::abs(month.z) > options_.z_persistent;
    if (!doubtful || !same_side) believe_doubted();
    if (!doubtful) {
      believe(month);
      return;
    }
    doubted_.push_back(month);
    const bool persistent = static_cast<int>(doubted_.size()) >= options_.months_persistent;
    if (std::abs(month.z) > options_.z_max || persistent) {
      const Compared first = doubted_.front();
      open(LevelChangeKind::level, first, persistent ? first.z : month.z, month.figure->month);
    }
  }

  void believe(const Compared& month) {
    learned_.push_back(month.log_ratio);
    accept_level(month.figure->month, month.level);
  }

  void believe_doubted() {
    for (const Compared& month : doubted_) believe(month);
    doubted_.clear();
  }

  void open(LevelChangeKind kind, const Compared& month, double z, Month seen) {
    const MonthlyFigure& figure = *month.figure;
    LevelChange change{
        kind, figure.month, seen, {}, std::exp(month.log_ratio), std::exp(month.step), z, {}};
    change.words = kind == LevelChangeKind::level ? level_in_words(change) : scale_in_words(change);
    changes_.push_back(std::move(change));
    doubted_.clear();
    open_ = true;
    as_before_ = 0;
  }

  [[nodiscard]] std::string level_in_words(const LevelChange& change) const {
    return meter_name_ + " has differed from the same months of earlier years since " +
           to_string(change.since) + ": " +
           text("%+.0f %% in that month (%.1f times its usual scatter)",
                100.0 * (change.ratio - 1.0), std::abs(change.z));
  }

  [[nodiscard]] std::string scale_in_words(const LevelChange& change) const {
    return meter_name_ + " has read about " + factor_in_words(change.factor) +
           " its earlier level since " + to_string(change.since) +
           ": probably a changed unit or multiplier, not the building";
  }

  void count_return(Month month, bool as_before) {
    if (!as_before) {
      as_before_ = 0;
      return;
    }
    if (as_before_++ == 0) first_as_before_ = month;
    if (as_before_ < options_.months_to_return) return;
    for (LevelChange& change : changes_) {
      if (!change.back_since) change.back_since = first_as_before_;
    }
    open_ = false;
  }

  std::string meter_name_;
  const LevelChangeOptions& options_;
  std::map<unsigned, std::vector<double>> undisputed_;  ///< Levels by calendar month.
  std::vector<double> learned_;                         ///< Undisputed log ratios.
  std::vector<double> recent_;                          ///< The last few log ratios of any kind.
  std::vector<Compared> doubted_;                       ///< In a row off to one side, not yet open.
  std::vector<Compared> stepped_;                       ///< In a row off by a whole factor.
  double largest_level_ = -std::numeric_limits<double>::infinity();
  std::vector<LevelChange> changes_;
  bool open_ = false;
  int as_before_ = 0;
  Month first_as_before_{};
};

bool holds_in(const LevelChange& change, Month month) {
  return month >= change.since && (!change.back_since || month < *change.back_since);
}

}  // namespace

LevelChangeOptions level_change_options(Utility utility) {
  LevelChangeOptions options;
  const bool by_weather = utility != Utility::electricity && utility != Utility::water;
  if (by_weather) {
    options.typical_scatter = 0.15;
    options.small_month = 0.25;      // chilled water in a mild January may be only half
    options.scale_factor_min = 8.0;  // a cold March after a mild winter is a step of 5.5
    options.scale_months = 2;
  }
  return options;
}

std::vector<LevelChange> find_level_changes(std::string_view meter_name,
                                            std::span<const MonthlyFigure> figures,
                                            const LevelChangeOptions& options) {
  LevelWatch watch{meter_name, options};
  for (const MonthlyFigure& figure : figures) watch.see(figure);
  return watch.take();
}

bool is_different(std::span<const LevelChange> changes, Month month) {
  return std::any_of(changes.begin(), changes.end(),
                     [&](const LevelChange& change) { return holds_in(change, month); });
}

bool is_rescaled(std::span<const LevelChange> changes, Month month) {
  return std::any_of(changes.begin(), changes.end(), [&](const LevelChange& change) {
    return change.kind == LevelChangeKind::scale && holds_in(change, month);
  });
}

}  // namespace recald::metering
