#include "core/model/prior.hpp"

#include <algorithm>
#include <boost/math/special_functions/erf.hpp>
#include <cassert>
#include <cmath>
#include <locale>
#include <numbers>
#include <sstream>
#include <utility>

namespace recald {
namespace {

constexpr double kLeastProbability = 1e-12;  // least probability of a normal between its bounds

double normal_density(double x) {
  return std::exp(-0.5 * x * x) / std::sqrt(2.0 * std::numbers::pi);
}

double normal_below(double x) { return 0.5 * std::erfc(-x / std::numbers::sqrt2); }
double normal_above(double x) { return normal_below(-x); }

/// A truncated normal in standard units: the prior itself, or its logarithm.
struct CutNormal {
  double location;
  double sd;
  double low;  ///< Bounds in standard units, may be infinite.
  double high;

  /// Probability between the bounds, computed from the tail without cancellation.
  [[nodiscard]] double mass() const {
    return low > 0.0 ? normal_above(low) - normal_above(high)
                     : normal_below(high) - normal_below(low);
  }

  /// The standard score that splits the mass into shares `below` and `above`.
  [[nodiscard]] double score(double below, double above) const {
    constexpr double tiny = 1e-300;  // erfc_inv is not defined at 0
    const double all = mass();
    const double lower = std::max(tiny, normal_below(low) + below * all);
    const double upper = std::max(tiny, normal_above(high) + above * all);
    const double x = lower < upper
                         ? -std::numbers::sqrt2 * boost::math::erfc_inv(std::min(2.0 * lower, 1.0))
                         : std::numbers::sqrt2 * boost::math::erfc_inv(std::min(2.0 * upper, 1.0));
    return std::clamp(x, low, high);
  }

  [[nodiscard]] double share_below(double x) const {
    if (x <= low) return 0.0;
    if (x >= high) return 1.0;
    return low > 0.0 ? (normal_above(low) - normal_above(x)) / mass()
                     : (normal_below(x) - normal_below(low)) / mass();
  }
};

CutNormal cut(const TruncatedNormalPrior& p) {
  return {p.location, p.sd, (p.min - p.location) / p.sd, (p.max - p.location) / p.sd};
}

CutNormal cut(const LogNormalPrior& p) {
  const double location = std::log(p.median);
  return {location, p.log_sd, (std::log(p.min) - location) / p.log_sd,
          (std::log(p.max) - location) / p.log_sd};
}

struct Moments {
  double mean;
  double variance;
};

Moments moments(const TriangularPrior& p) {
  return {(p.min + p.mode + p.max) / 3.0, (p.min * p.min + p.mode * p.mode + p.max * p.max -
                                           p.min * p.mode - p.min * p.max - p.mode * p.max) /
                                              18.0};
}

Moments moments(const UniformPrior& p) {
  return {0.5 * (p.min + p.max), (p.max - p.min) * (p.max - p.min) / 12.0};
}

Moments moments(const TruncatedNormalPrior& p) {
  const CutNormal c = cut(p);
  const auto weighted = [](double x) { return std::isfinite(x) ? x * normal_density(x) : 0.0; };
  const double shift = (normal_density(c.low) - normal_density(c.high)) / c.mass();
  const double growth = (weighted(c.low) - weighted(c.high)) / c.mass();
  return {p.location + p.sd * shift, p.sd * p.sd * (1.0 + growth - shift * shift)};
}

Moments moments(const LogNormalPrior& p) {
  const CutNormal c = cut(p);
  // E[X^k] of exp(normal) is that of the normal shifted by k times its variance.
  const auto raw = [&](double k) {
    const CutNormal moved{0.0, 1.0, c.low - k * c.sd, c.high - k * c.sd};
    return std::exp(k * c.location + 0.5 * k * k * c.sd * c.sd) * moved.mass() / c.mass();
  };
  const double mean = raw(1.0);
  return {mean, raw(2.0) - mean * mean};
}

Result<void> fault(const TriangularPrior& p) {
  const bool finite = std::isfinite(p.min) && std::isfinite(p.mode) && std::isfinite(p.max);
  if (finite && p.min < p.max && p.min <= p.mode && p.mode <= p.max) return {};
  std::ostringstream text;
  text.imbue(std::locale::classic());
  text << "a triangular prior needs min <= mode <= max and min < max, but min = " << p.min
       << ", mode = " << p.mode << ", max = " << p.max;
  return failure(ErrorCode::invalid_value, text.str());
}

Result<void> fault(const UniformPrior& p) {
  if (std::isfinite(p.min) && std::isfinite(p.max) && p.min < p.max) return {};
  std::ostringstream text;
  text.imbue(std::locale::classic());
  text << "a uniform prior needs min < max, but min = " << p.min << ", max = " << p.max;
  return failure(ErrorCode::invalid_value, text.str());
}

Result<void> cut_fault(const CutNormal& c, double min, double max, const char* name) {
  std::ostringstream text;
  text.imbue(std::locale::classic());
  text << "a " << name << " prior ";
  if (!(min < max)) {
    text << "needs min < max, but min = " << min << ", max = " << max;
  } else if (!(c.mass() > kLeastProbability)) {
    text << "has next to no probability (" << c.mass() << ") between its ends, min = " << min
         << " and max = " << max << ", so recald cannot draw from it; move the ends or the centre";
  } else {
    return {};
  }
  return failure(ErrorCode::invalid_value, text.str());
}

Result<void> fault(const TruncatedNormalPrior& p) {
  if (!(std::isfinite(p.location) && std::isfinite(p.sd) && p.sd > 0.0)) {
    std::ostringstream text;
    text.imbue(std::locale::classic());
    text << "a truncated normal prior needs a finite centre and an sd above 0, but they are "
         << p.location << " and " << p.sd;
    return failure(ErrorCode::invalid_value, text.str());
  }
  return cut_fault(cut(p), p.min, p.max, "truncated normal");
}

Result<void> fault(const LogNormalPrior& p) {
  const bool usable = std::isfinite(p.median) && p.median > 0.0 && std::isfinite(p.log_sd) &&
                      p.log_sd > 0.0 && p.min >= 0.0;
  if (!usable) {
    std::ostringstream text;
    text.imbue(std::locale::classic());
    text << "a log-normal prior needs a median above 0, an sd of the logarithm above 0 and "
            "non-negative ends, but they are "
         << p.median << ", " << p.log_sd << " and min = " << p.min;
    return failure(ErrorCode::invalid_value, text.str());
  }
  return cut_fault(cut(p), p.min, p.max, "log-normal");
}

double density_of(const TriangularPrior& p, double value) {
  const double range = p.max - p.min;
  if (value < p.mode) return 2.0 * (value - p.min) / (range * (p.mode - p.min));
  if (value > p.mode) return 2.0 * (p.max - value) / (range * (p.max - p.mode));
  return 2.0 / range;
}

double density_of(const UniformPrior& p, double /*value*/) { return 1.0 / (p.max - p.min); }

double density_of(const TruncatedNormalPrior& p, double value) {
  const CutNormal c = cut(p);
  return normal_density((value - p.location) / p.sd) / (p.sd * c.mass());
}

double density_of(const LogNormalPrior& p, double value) {
  if (value <= 0.0) return 0.0;
  const CutNormal c = cut(p);
  return normal_density((std::log(value) - c.location) / c.sd) / (value * c.sd * c.mass());
}

double cumulative_of(const TriangularPrior& p, double value) {
  const double range = p.max - p.min;
  if (value <= p.mode) return (value - p.min) * (value - p.min) / (range * (p.mode - p.min));
  return 1.0 - (p.max - value) * (p.max - value) / (range * (p.max - p.mode));
}

double cumulative_of(const UniformPrior& p, double value) {
  return (value - p.min) / (p.max - p.min);
}

double cumulative_of(const TruncatedNormalPrior& p, double value) {
  return cut(p).share_below((value - p.location) / p.sd);
}

double cumulative_of(const LogNormalPrior& p, double value) {
  const CutNormal c = cut(p);
  return c.share_below((std::log(value) - c.location) / c.sd);
}

}  // namespace

Result<Prior> Prior::make(Distribution distribution) {
  TRY(std::visit([](const auto& d) { return fault(d); }, distribution));
  return Prior(std::move(distribution));
}

Result<Prior> Prior::named(std::string_view distribution, const PriorNumbers& numbers) {
  const auto absent = [&](const char* what) {
    std::string sentence = "a ";
    sentence += distribution;
    sentence += " prior needs ";
    return failure(ErrorCode::invalid_value, sentence + what);
  };
  constexpr double infinity = std::numeric_limits<double>::infinity();
  const auto& [min, mode, max, sd] = numbers;
  if (distribution == "triangular") {
    if (!min || !mode || !max) return absent("min, mode and max");
    return make(TriangularPrior{*min, *mode, *max});
  }
  if (distribution == "uniform") {
    if (!min || !max) return absent("min and max");
    return make(UniformPrior{*min, *max});
  }
  if (distribution == "truncated_normal") {
    if (!mode || !sd) return absent("mode (its centre) and sd");
    return make(TruncatedNormalPrior{*mode, *sd, min.value_or(-infinity), max.value_or(infinity)});
  }
  if (distribution == "log_normal") {
    if (!mode || !sd) return absent("mode (its median) and sd (of the logarithm)");
    return make(LogNormalPrior{*mode, *sd, min.value_or(0.0), max.value_or(infinity)});
  }
  std::string sentence = "no prior has the distribution '";
  sentence += distribution;
  sentence += "'; known are triangular, uniform, truncated_normal and log_normal";
  return failure(ErrorCode::invalid_value, std::move(sentence));
}

PriorNumbers Prior::numbers() const {
  if (const auto* p = std::get_if<TriangularPrior>(&distribution_)) {
    return {p->min, p->mode, p->max, {}};
  }
  if (const auto* p = std::get_if<TruncatedNormalPrior>(&distribution_)) {
    return {p->min, p->location, p->max, p->sd};
  }
  if (const auto* p = std::get_if<LogNormalPrior>(&distribution_)) {
    return {p->min, p->median, p->max, p->log_sd};
  }
  return {min(), {}, max(), {}};
}

Prior::Prior(double min, double mode, double max) : Prior(TriangularPrior{min, mode, max}) {}

Prior::Prior(Checked, Distribution distribution) : distribution_(std::move(distribution)) {
  assert(std::visit([](const auto& d) { return fault(d).has_value(); }, distribution_));
  const Moments m = std::visit([](const auto& d) { return moments(d); }, distribution_);
  mean_ = m.mean;
  variance_ = m.variance;
}

double Prior::density(double value) const {
  if (value < min() || value > max()) return 0.0;
  return std::visit([value](const auto& d) { return density_of(d, value); }, distribution_);
}

double Prior::cumulative(double value) const {
  if (value <= min()) return 0.0;
  if (value >= max()) return 1.0;
  return std::visit([value](const auto& d) { return cumulative_of(d, value); }, distribution_);
}

double Prior::quantile(double probability) const {
  assert(probability >= 0.0 && probability <= 1.0);
  return locate(probability, 1.0 - probability).value;
}

ScoredValue Prior::at_score(double score) const {
  const Located at = locate(normal_below(score), normal_above(score));
  // Far out both densities vanish, the normal's first.
  const double slope = at.density > 0.0 ? normal_density(score) / at.density : 0.0;
  return {at.value, slope};
}

Prior::Located Prior::locate(double below, double above) const {
  if (const auto* p = std::get_if<TriangularPrior>(&distribution_)) {
    const double range = p->max - p->min;
    const double rise = range * (p->mode - p->min);
    const double fall = range * (p->max - p->mode);
    if (below * range < p->mode - p->min) {
      const double past_min = std::sqrt(below * rise);
      return {p->min + past_min, 2.0 * past_min / rise};
    }
    const double before_max = std::sqrt(above * fall);
    return {p->max - before_max, fall > 0.0 ? 2.0 * before_max / fall : 2.0 / range};
  }
  if (const auto* p = std::get_if<UniformPrior>(&distribution_)) {
    const double range = p->max - p->min;
    return {below < above ? p->min + below * range : p->max - above * range, 1.0 / range};
  }
  if (const auto* p = std::get_if<TruncatedNormalPrior>(&distribution_)) {
    const CutNormal c = cut(*p);
    const double score = c.score(below, above);
    return {std::clamp(c.location + c.sd * score, p->min, p->max),
            normal_density(score) / (c.sd * c.mass())};
  }
  const auto& p = std::get<LogNormalPrior>(distribution_);
  const CutNormal c = cut(p);
  const double score = c.score(below, above);
  const double value = std::clamp(std::exp(c.location + c.sd * score), p.min, p.max);
  return {value, normal_density(score) / (value * c.sd * c.mass())};
}

double Prior::mode() const {
  if (const auto* p = std::get_if<TriangularPrior>(&distribution_)) return p->mode;
  if (const auto* p = std::get_if<UniformPrior>(&distribution_)) return 0.5 * (p->min + p->max);
  if (const auto* p = std::get_if<TruncatedNormalPrior>(&distribution_)) {
    return std::clamp(p->location, p->min, p->max);
  }
  const auto& p = std::get<LogNormalPrior>(distribution_);
  return std::clamp(p.median * std::exp(-p.log_sd * p.log_sd), p.min, p.max);
}

double Prior::min() const {
  return std::visit([](const auto& d) { return d.min; }, distribution_);
}

double Prior::max() const {
  return std::visit([](const auto& d) { return d.max; }, distribution_);
}

std::string_view Prior::name() const {
  constexpr std::string_view names[] = {"triangular", "uniform", "truncated_normal", "log_normal"};
  return names[distribution_.index()];
}

}  // namespace recald
