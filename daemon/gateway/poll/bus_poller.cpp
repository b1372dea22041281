#include "daemon/gateway/poll/bus_poller.hpp"

#include <algorithm>
#include <cassert>

#include "adapters/modbus/frame.hpp"

namespace recald::daemon {
namespace {

using modbus::ReadFault;
using std::chrono::milliseconds;

/// If the clocks have drifted apart by more than this since the last check, the wall clock was set.
constexpr milliseconds kClockSet{500};
/// If no silent unit had a turn for this long, one gets it even if others are due.
constexpr milliseconds kPatience{60'000};
/// Probes may take this long before their share of the bus's time is checked.
constexpr milliseconds kProbeCredit{5'000};

}  // namespace

BusPoller::BusPoller(std::vector<PolledUnit> units, const BusRules& rules, Rng rng)
    : units_(std::move(units)), rules_(rules), rng_(rng) {
  for (std::size_t i = 0; i < units_.size(); ++i) {
    assert(!units_[i].reads.empty());
    states_.push_back(unknown(i));
  }
}

BusPoller::UnitPolling BusPoller::unknown(std::size_t unit) const {
  const PolledUnit& polled = units_[unit];
  return {.times = PollTimes{polled.period, polled.interval, polled.phase},
          .health = UnitHealth{rules_.health},
          .timeout = LearnedTimeout{polled.timeout},
          .refusals = std::vector<Refusal>(polled.reads.size())};
}

/// At the first call, and after the wall clock was set, all polls are scheduled anew.
void BusPoller::notice_clock(const Moment& now) {
  const milliseconds offset = now.wall.time_since_epoch() - now.monotonic;
  const bool is_first = !wall_minus_monotonic_.has_value();
  if (is_first) begun_ = now.monotonic;
  const bool was_set = !is_first && (offset - *wall_minus_monotonic_ > kClockSet ||
                                     *wall_minus_monotonic_ - offset > kClockSet);
  wall_minus_monotonic_ = offset;
  if (!is_first && !was_set) return;
  for (UnitPolling& polling : states_) {
    polling.to_read.clear();
    polling.is_asked = false;
    // At the start all units are polled within a second, to show values; then the schedule applies.
    polling.due =
        is_first ? now.wall + polling.times.boundary_delay() : polling.times.after(now.wall);
  }
}

void BusPoller::begin_due_polls(const Moment& now) {
  for (std::size_t i = 0; i < units_.size(); ++i) {
    UnitPolling& polling = states_[i];
    // A poll that has started keeps its due time, which identifies the reads that belong together.
    if (polling.due > now.wall || polling.is_asked) continue;
    const bool is_waiting = !polling.to_read.empty();
    if (!is_waiting) polling.since = polling.due;
    for (WallTime later = polling.times.after(polling.due); later <= now.wall;
         later = polling.times.after(polling.due)) {
      polling.due = later;
      ++polling.skipped;
    }
    if (is_waiting) continue;
    for (std::size_t read = units_[i].reads.size(); read-- > 0;) {
      const bool may_ask = polling.refusals[read].until <= now.monotonic;
      if (may_ask && is_made(i, read)) polling.to_read.push_back(read);
    }
    if (polling.to_read.empty()) end_poll(i);
  }
}

/// Of a read and those that are made instead, only one kind is.
bool BusPoller::is_made(std::size_t unit, std::size_t read) const {
  const std::vector<Refusal>& refusals = states_[unit].refusals;
  const auto instead_of = units_[unit].reads[read].instead_of;
  return instead_of ? refusals[*instead_of].is_split : !refusals[read].is_split;
}

/// A device may lack registers between those of two fields.
bool BusPoller::split(const BusOrder& order, const modbus::ReadFailure& failure) {
  const std::vector<modbus::PlannedRead>& reads = units_[order.unit].reads;
  UnitPolling& polling = states_[order.unit];
  if (!reads[order.read].may_split || !modbus::is_illegal_span(failure)) return false;
  std::vector<std::size_t> instead;
  for (std::size_t i = reads.size(); i-- > 0;) {
    if (reads[i].instead_of == order.read) instead.push_back(i);
  }
  polling.refusals[order.read] = {.is_split = true};
  polling.to_read.pop_back();
  polling.to_read.insert(polling.to_read.end(), instead.begin(), instead.end());
  return true;
}

bool BusPoller::is_reliable(const UnitPolling& polling) const {
  const bool is_trusted = polling.has_answered || all_have_answered_;
  return is_trusted && polling.health.state() == UnitState::up;
}

/// Whether a read that may take `timeout` ends before an answering unit falls due.
bool BusPoller::fits_before_reliable(milliseconds timeout, const Moment& now) const {
  return std::ranges::none_of(states_, [&](const UnitPolling& polling) {
    return is_reliable(polling) && polling.due < now.wall + timeout;
  });
}

bool BusPoller::was_patient(const Moment& now) const {
  return now.monotonic - silent_asked_ >= kPatience;
}

std::optional<std::size_t> BusPoller::choose(const Moment& now) const {
  const auto goes_first = [&](const UnitPolling& polling) {
    return is_reliable(polling) || (was_patient(now) && now.wall - polling.since >= kPatience);
  };
  std::optional<std::size_t> chosen;
  for (std::size_t i = 0; i < states_.size(); ++i) {
    const UnitPolling& polling = states_[i];
    if (polling.to_read.empty() || polling.not_before > now.monotonic) continue;
    if (polling.health.state() == UnitState::down) continue;
    const bool first = goes_first(polling);
    if (!first && !fits_before_reliable(polling.timeout.timeout(), now)) continue;
    if (!chosen) {
      chosen = i;
      continue;
    }
    const UnitPolling& best = states_[*chosen];
    if (first != goes_first(best) ? first : polling.since < best.since) chosen = i;
  }
  return chosen;
}

BusOrder BusPoller::order_for(std::size_t unit, bool is_probe, const Moment& now) {
  const PolledUnit& polled = units_[unit];
  UnitPolling& polling = states_[unit];
  const bool begins_poll = !is_probe && !polling.is_asked;
  if (!is_probe) polling.is_asked = true;
  const std::size_t read = is_probe ? 0 : polling.to_read.back();
  const modbus::PlannedRead& planned = polled.reads[read];
  under_way_ = true;
  if (!is_reliable(polling)) silent_asked_ = now.monotonic;
  return {.unit = unit,
          .read = read,
          .request = {polled.unit, planned.function, planned.address, planned.count},
          .timeout = is_probe ? polling.timeout.probe_timeout() : polling.timeout.timeout(),
          .due = polling.due,
          .is_probe = is_probe,
          .begins_poll = begins_poll};
}

std::optional<BusOrder> BusPoller::probe(const Moment& now) {
  const auto allowed =
      kProbeCredit +
      milliseconds{static_cast<std::int64_t>(
          rules_.probe_share * static_cast<double>((now.monotonic - begun_).count()))};
  if (probing_ > allowed) return {};
  std::optional<std::size_t> chosen;
  for (std::size_t i = 0; i < states_.size(); ++i) {
    const UnitHealth& health = states_[i].health;
    if (health.state() != UnitState::down || health.next_probe() > now.monotonic) continue;
    if (!chosen || health.next_probe() < states_[*chosen].health.next_probe()) chosen = i;
  }
  if (!chosen) return {};
  const UnitPolling& polling = states_[*chosen];
  const bool is_overdue =
      was_patient(now) && now.monotonic - polling.health.next_probe() >= kPatience;
  if (!is_overdue && !fits_before_reliable(polling.timeout.probe_timeout(), now)) return {};
  return order_for(*chosen, true, now);
}

std::optional<BusOrder> BusPoller::next(const Moment& now) {
  notice_clock(now);
  if (under_way_ || now.monotonic < std::max(gap_until_, rest_until_)) return {};
  begin_due_polls(now);
  if (const auto unit = choose(now)) return order_for(*unit, false, now);
  return probe(now);
}

milliseconds BusPoller::wait(const Moment& now) const {
  assert(!under_way_);
  milliseconds shortest = kLongestWait;
  const auto no_later = [&](milliseconds from_now) {
    shortest = std::clamp(from_now, milliseconds{1}, shortest);
  };
  const milliseconds closed = std::max(gap_until_, rest_until_);
  if (closed > now.monotonic) {
    no_later(closed - now.monotonic);
    return shortest;
  }
  for (const UnitPolling& polling : states_) {
    if (polling.health.state() == UnitState::down) {
      // A probe that is already due waits for the answering units, which are in this list.
      const milliseconds probe = polling.health.next_probe() - now.monotonic;
      if (probe > milliseconds{0}) no_later(probe);
    } else if (polling.to_read.empty()) {
      no_later(polling.due - now.wall);
    } else if (polling.not_before > now.monotonic) {
      no_later(polling.not_before - now.monotonic);
    } else {
      no_later(std::max(polling.since + kPatience - now.wall,
                        silent_asked_ + kPatience - now.monotonic));
    }
  }
  return shortest;
}

void BusPoller::end_poll(std::size_t unit) {
  UnitPolling& polling = states_[unit];
  polling.to_read.clear();
  polling.is_asked = false;
  polling.busy = 0;
  polling.not_before = milliseconds{0};
  polling.due = polling.times.after(polling.due);
}

void BusPoller::take_exception(const BusOrder& order, const modbus::ReadFailure& failure,
                               const Moment& now) {
  UnitPolling& polling = states_[order.unit];
  if (modbus::is_busy(failure.exception_code) && polling.busy < rules_.busy_retries) {
    ++polling.busy;
    polling.not_before = now.monotonic + rules_.busy_wait;
    return;
  }
  if (split(order, failure)) return;
  Refusal& refusal = polling.refusals[order.read];
  refusal.is_busy = modbus::is_busy(failure.exception_code);
  if (modbus::is_refusal(failure)) {
    refusal.wait = refusal.wait == milliseconds{0} ? rules_.refused_min
                                                   : std::min(2 * refusal.wait, rules_.refused_max);
    refusal.until = now.monotonic + refusal.wait;
  }
  polling.busy = 0;
  polling.to_read.pop_back();
}

void BusPoller::take_silence(const BusOrder& order, const Moment& now) {
  UnitPolling& polling = states_[order.unit];
  all_have_answered_ = all_have_answered_ && polling.has_answered;
  polling.health.missed(now.monotonic, rng_);
  polling.timeout.missed();
  if (!order.is_probe) end_poll(order.unit);
}

void BusPoller::rest(const Moment& now) {
  rest_length_ = rest_length_ == milliseconds{0} ? rules_.reconnect_min
                                                 : std::min(2 * rest_length_, rules_.reconnect_max);
  rest_until_ =
      now.monotonic + milliseconds{static_cast<std::int64_t>(
                          static_cast<double>(rest_length_.count()) * rng_.uniform(0.8, 1.2))};
}

void BusPoller::answered(const BusOrder& order, const modbus::ReadResult& result,
                         milliseconds duration, const Moment& now) {
  assert(under_way_);
  under_way_ = false;
  gap_until_ = now.monotonic + rules_.request_gap;
  if (order.is_probe) probing_ += duration;
  UnitPolling& polling = states_[order.unit];
  // The clock was set during this order, so its poll is no longer on the schedule.
  const bool is_stale = !order.is_probe && polling.to_read.empty();

  const bool is_lost = !result && (result.error().fault == ReadFault::refused ||
                                   result.error().fault == ReadFault::closed);
  lost_connections_ = is_lost ? lost_connections_ + 1 : 0;
  // A device that closes on one unit's request may still serve others, so only the
  // second time counts.
  if (is_lost && (result.error().fault == ReadFault::refused || lost_connections_ > 1)) rest(now);

  const bool lives = result || (result.error().fault == ReadFault::exception &&
                                !modbus::is_from_gateway(result.error().exception_code));
  if (!lives) {
    if (is_stale) {
      polling.health.missed(now.monotonic, rng_);
    } else {
      take_silence(order, now);
    }
    return;
  }
  rest_length_ = milliseconds{0};
  polling.has_answered = true;
  polling.health.answered();
  polling.timeout.answered(duration);
  if (order.is_probe) {
    polling.due = now.wall;  // the unit is back: read the whole poll at once
    polling.to_read.clear();
    polling.is_asked = false;
    return;
  }
  if (is_stale) return;
  if (!result) {
    take_exception(order, result.error(), now);
  } else {
    polling.busy = 0;
    polling.refusals[order.read] = {};
    polling.to_read.pop_back();
  }
  if (polling.to_read.empty()) end_poll(order.unit);
}

UnitState BusPoller::state(std::size_t unit) const {
  const UnitPolling& polling = states_[unit];
  const UnitState health = polling.health.state();
  const bool refuses = std::ranges::any_of(polling.refusals, [](const Refusal& one) {
    return one.wait > milliseconds{0} || one.is_busy;
  });
  return health == UnitState::up && refuses ? UnitState::degraded : health;
}

void BusPoller::begin_anew() {
  for (std::size_t i = 0; i < units_.size(); ++i) {
    const std::uint64_t skipped = states_[i].skipped;
    states_[i] = unknown(i);
    states_[i].skipped = skipped;
  }
  under_way_ = false;
  all_have_answered_ = true;
  wall_minus_monotonic_.reset();
  probing_ = milliseconds{0};
  silent_asked_ = milliseconds{0};
  gap_until_ = milliseconds{0};
  rest_until_ = milliseconds{0};
  rest_length_ = milliseconds{0};
  lost_connections_ = 0;
}

}  // namespace recald::daemon
