#include "core/metering/registers/late_stamps.hpp"

#include <algorithm>
#include <cmath>

namespace recald::metering {
namespace {

using std::chrono::seconds;

constexpr seconds kBesideMax{120};
constexpr double kSameShare = 0.005;   // of an interval: a spread that moves no peak
constexpr std::ptrdiff_t kAround = 4;  // samples to each side, by which the load is known
constexpr double kSudden = 0.5;        // a load that differs by more from that around it
constexpr double kErrorsApart = 2.0;

/// From the nearest start of an interval; late is positive.
seconds beside(Instant time, seconds interval) {
  const seconds late = time.time_since_epoch() % interval;
  return 2 * late > interval ? late - interval : late;
}

bool is_near(seconds off, seconds interval) {
  return std::chrono::abs(off) <= std::min(kBesideMax, interval / kToleranceShare);
}

/// A regression through the origin, with an error that holds for residuals of any sizes.
class Slope {
 public:
  void take(double x, double y) { points_.emplace_back(x, y); }

  /// @return the half's side in standard errors; 0 without a spread
  [[nodiscard]] double errors_above_half() const {
    double xx = 0.0;
    double xy = 0.0;
    for (const auto& [x, y] : points_) {
      xx += x * x;
      xy += x * y;
    }
    if (xx == 0.0) return 0.0;
    const double slope = xy / xx;
    double scatter = 0.0;
    for (const auto& [x, y] : points_) scatter += std::pow(x * (y - slope * x), 2);
    return (slope - 0.5) / std::max(std::sqrt(scatter) / xx, 1e-9);
  }

 private:
  std::vector<std::pair<double, double>> points_;
};

}  // namespace

StampsBeside judge_stamps(std::span<const RegisterSample> samples, seconds interval) {
  seconds least = seconds::max();
  seconds most = seconds::min();
  for (const RegisterSample& sample : samples) {
    const seconds off = beside(sample.time, interval);
    if (!is_near(off, interval)) continue;
    least = std::min(least, off);
    most = std::max(most, off);
  }
  const double interval_s = static_cast<double>(interval.count());
  if (least > most || static_cast<double>((most - least).count()) <= kSameShare * interval_s) {
    return StampsBeside::none;
  }
  Slope slope;
  const auto count = std::ssize(samples);
  for (std::ptrdiff_t i = kAround + 1; i + kAround < count; ++i) {
    const auto at = [&](std::ptrdiff_t k) { return samples[static_cast<std::size_t>(k)]; };
    const auto spans_one = [&](std::ptrdiff_t k) {
      const seconds off = beside(at(k).time, interval);
      const seconds before = beside(at(k - 1).time, interval);
      return is_near(off, interval) && is_near(before, interval) &&
             at(k).time - off == at(k - 1).time - before + interval;
    };
    bool is_whole = true;
    double around = 0.0;
    for (std::ptrdiff_t k = i - kAround + 1; k < i + kAround && is_whole; ++k) {
      is_whole = spans_one(k);
      // Its own neighbours share a stamp with it.
      if (std::abs(k - i) > 1) around += at(k).value_kWh - at(k - 1).value_kWh;
    }
    if (!is_whole || !(around > 0.0)) continue;
    const double usual_kWh = around / static_cast<double>(2 * (kAround - 2));
    const double more = (at(i).value_kWh - at(i - 1).value_kWh) / usual_kWh - 1.0;
    if (!(std::abs(more) <= kSudden)) continue;
    slope.take(static_cast<double>((at(i).time - at(i - 1).time - interval).count()) / interval_s,
               more);
  }
  const double above = slope.errors_above_half();
  if (above > kErrorsApart) return StampsBeside::as_read;
  return above < -kErrorsApart ? StampsBeside::as_grid : StampsBeside::unclear;
}

void put_on_grid(std::vector<RegisterSample>& samples, seconds interval) {
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const seconds off = beside(samples[i].time, interval);
    if (!is_near(off, interval)) continue;
    const Instant time = samples[i].time - off;
    if (i == 0 || time > samples[i - 1].time) samples[i].time = time;
  }
}

}  // namespace recald::metering
