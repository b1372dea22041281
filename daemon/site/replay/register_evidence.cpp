#include "daemon/site/replay/register_evidence.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>

namespace recald::daemon {
namespace {

using metering::Instant;
using metering::LocalCalendar;
using metering::RegisterSample;
using metering::Resets;
using std::chrono::seconds;

constexpr std::uint64_t kRisesMin = 20;
constexpr std::uint64_t kRisesPerFall = 200;
constexpr std::size_t kFallsKept = 20'000;  // one a day for more than fifty years
constexpr std::uint64_t kFallsTried = 64;   // of what falls as often as it rises
constexpr std::uint64_t kRisesPerReset = 4;
constexpr std::size_t kLargestKept = 64;
constexpr std::size_t kConfirmedBy = 3;  // others of half the size or more
constexpr seconds kRateMin{60};          // a step of the register is no load over less
constexpr int kBounceMax = 3;            // samples that a misread register stays low
constexpr double kNearlyAll = 0.95;
constexpr double kRestOfReset = 0.3;     // that is left of a register that was set to zero
constexpr double kDaysWithResets = 0.3;  // on the others nothing was used
constexpr double kFarInSteps = 50.0;     // how far a net register moves, in its largest steps
constexpr double kLargeStep = 2.0;       // of them: an exchange, or another load
constexpr double kRatedMargin = 1.5;
constexpr double kRatedDoubt = 1.2;  // of the rating: as a counter doubts a rise
constexpr std::size_t kExchangesMax = 20;

double round_up(double value) {
  const double step = std::pow(10.0, std::floor(std::log10(std::max(value, 1e-6))) - 1.0);
  return std::ceil(value / step) * step;
}

/// A clock that is never changed, so many hours ahead of UTC.
std::string fixed_zone_name(int ahead) {
  // POSIX counts westwards.
  return ahead == 0 ? "Etc/UTC"
                    : fmt::format("Etc/GMT{}{}", ahead > 0 ? '-' : '+', std::abs(ahead));
}

/// The start of the local day or month in which the step ends, if the step spans it.
std::optional<Instant> reset_in(const RegisterStep& step, const LocalCalendar& calendar,
                                Resets resets) {
  const auto span = resets == Resets::daily
                        ? calendar.day_span(calendar.local_time(step.to.time).date)
                        : calendar.month_span(calendar.month_of(step.to.time));
  // A sample may be taken some seconds late, and be stamped so.
  constexpr seconds kLate{120};
  return span.begin + kLate >= step.from.time ? std::optional{span.begin} : std::nullopt;
}

}  // namespace

void RegisterEvidence::Largest::take(double size, const RegisterStep& step) {
  const auto larger = [](const One& a, const One& b) { return a.size > b.size; };
  if (heap.size() == kLargestKept) {
    if (size <= heap.front().size) return;
    std::ranges::pop_heap(heap, larger);
    heap.pop_back();
  }
  heap.push_back({size, step});
  std::ranges::push_heap(heap, larger);
}

double RegisterEvidence::Largest::confirmed() const {
  std::vector<double> sizes;
  for (const One& one : heap) sizes.push_back(one.size);
  std::ranges::sort(sizes, std::greater{});
  for (std::size_t i = 0; i + kConfirmedBy < sizes.size(); ++i) {
    if (2.0 * sizes[i + kConfirmedBy] >= sizes[i]) return sizes[i];
  }
  return sizes.empty() ? 0.0 : sizes.back();
}

/// Whether small steps reach so far: a load that was once much larger has gone there in two.
bool RegisterEvidence::Largest::reach_small(double range) const {
  const double small = confirmed();
  for (const One& one : heap) {
    if (one.size > kLargeStep * small) range -= one.size;
  }
  return range >= kFarInSteps * small;
}

void RegisterEvidence::take(Instant time, double value_kWh) {
  const RegisterSample sample{time, value_kWh};
  if (!std::isfinite(value_kWh) || (last_ && time <= last_->time)) return;
  if (!first_) {
    first_ = sample;
    lowest_kWh_ = highest_kWh_ = value_kWh;
  }
  lowest_kWh_ = std::min(lowest_kWh_, value_kWh);
  highest_kWh_ = std::max(highest_kWh_, value_kWh);
  if (last_ && !take_back_bounce(sample)) {
    const RegisterStep step{*last_, sample};
    const double rise_kWh = value_kWh - last_->value_kWh;
    steps_kWh_.take(std::abs(rise_kWh), step);
    if (rise_kWh > 0.0) ++rises_;
    if (rise_kWh < 0.0) take_fall(step);
  }
  take_rate(sample);
  last_ = sample;
}

void RegisterEvidence::take_fall(const RegisterStep& step) {
  ++falls_;
  since_fall_ = 1;
  const bool is_hopeless = falls_ > kFallsTried && falls_ * kRisesPerReset > rises_;
  if (is_hopeless) kept_falls_ = {};
  if (!is_hopeless && kept_falls_.size() < kFallsKept) kept_falls_.push_back(step);
}

/// A register that was misread comes back to where it was: that is no fall, and no rise.
bool RegisterEvidence::take_back_bounce(const RegisterSample& sample) {
  if (since_fall_ == 0 || kept_falls_.empty()) return false;
  const RegisterSample& before = kept_falls_.back().from;
  const bool is_back = sample.value_kWh >= before.value_kWh;
  since_fall_ = is_back || since_fall_ == kBounceMax ? 0 : since_fall_ + 1;
  if (!is_back) return false;
  rate_from_ = before;
  kept_falls_.pop_back();
  --falls_;
  if (sample.value_kWh > before.value_kWh) ++rises_;
  return true;
}

void RegisterEvidence::take_rate(const RegisterSample& sample) {
  if (rate_from_ && sample.value_kWh >= rate_from_->value_kWh) {
    const seconds span = sample.time - rate_from_->time;
    if (span < kRateMin) return;
    const double rise_kWh = sample.value_kWh - rate_from_->value_kWh;
    if (rise_kWh > 0.0) rates_kW_.take(rise_kWh / metering::in_hours(span), {*rate_from_, sample});
  }
  rate_from_ = sample;
}

bool RegisterEvidence::hardly_falls() const { return falls_ * kRisesPerFall <= rises_; }

Resets RegisterEvidence::resets_by(const LocalCalendar& calendar) const {
  if (kept_falls_.size() < 2) return Resets::never;
  double before_kWh = 0.0;
  double after_kWh = 0.0;
  for (const RegisterStep& fall : kept_falls_) {
    before_kWh += fall.from.value_kWh;
    after_kWh += fall.to.value_kWh;
  }
  if (after_kWh > kRestOfReset * before_kWh) return Resets::never;
  const auto days = static_cast<double>((last_->time - first_->time) / metering::kDay);
  for (const Resets resets : {Resets::daily, Resets::monthly}) {
    const auto due = static_cast<double>(std::ranges::count_if(kept_falls_, [&](const auto& fall) {
      return reset_in(fall, calendar, resets).has_value();
    }));
    const bool are_all = due >= kNearlyAll * static_cast<double>(kept_falls_.size());
    if (are_all && (resets == Resets::monthly || due >= kDaysWithResets * days)) return resets;
  }
  return Resets::never;
}

void RegisterEvidence::find_resets(const LocalCalendar& calendar, RegisterVerdict& verdict) const {
  verdict.resets = resets_by(calendar);
  constexpr int kHoursBehind = 12;
  constexpr int kHoursAhead = 14;
  for (int ahead = -kHoursBehind; ahead <= kHoursAhead && verdict.resets == Resets::never;
       ++ahead) {
    const auto fixed = LocalCalendar::open(fixed_zone_name(ahead));
    if (!fixed) continue;
    verdict.resets = resets_by(*fixed);
    if (verdict.resets != Resets::never) verdict.reset_zone = fixed->zone_name();
  }
}

bool RegisterEvidence::may_rest() const {
  return first_ && falls_ == 0 && rises_ < kRisesMin && highest_kWh_ > 0.0;
}

RegisterVerdict RegisterEvidence::verdict(const LocalCalendar& calendar) const {
  RegisterVerdict verdict;
  verdict.rises = rises_;
  verdict.falls = falls_;
  verdict.rated_kW = round_up(kRatedMargin * rates_kW_.confirmed());
  if (rises_ < kRisesMin) return verdict;
  // What falls as often as it rises is looked at no further.
  if (falls_ * kRisesPerReset <= rises_ && falls_ == kept_falls_.size())
    find_resets(calendar, verdict);
  if (verdict.resets != Resets::never) {
    verdict.because = verdict.resets == Resets::daily
                          ? "it rises all day and falls to zero at midnight"
                          : "it rises all month and falls to zero when the next begins";
  } else if (hardly_falls()) {
    verdict.because = "its values hardly ever fall: a cumulative register";
  } else if (falls_ >= kRisesMin && steps_kWh_.reach_small(highest_kWh_ - lowest_kWh_)) {
    verdict.runs_back = true;
    verdict.because = "it moves far in small steps, up and down: a register that counts back";
  } else {
    return verdict;
  }
  verdict.is_register = true;
  find_exchanges(verdict);
  return verdict;
}

void RegisterEvidence::find_exchanges(RegisterVerdict& verdict) const {
  for (const Largest::One& one : rates_kW_.heap) {
    if (one.size > kRatedDoubt * verdict.rated_kW) verdict.exchanges.push_back(one.step);
  }
  if (verdict.resets == Resets::never && !verdict.runs_back) {
    verdict.exchanges.insert(verdict.exchanges.end(), kept_falls_.begin(), kept_falls_.end());
  }
  std::ranges::sort(verdict.exchanges, {}, [](const RegisterStep& step) { return step.to.time; });
  if (verdict.exchanges.size() > kExchangesMax) verdict.exchanges.resize(kExchangesMax);
}

}  // namespace recald::daemon
