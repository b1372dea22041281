#include "core/metering/registers/interval_book.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numeric>

#include "core/absent.hpp"

namespace recald::metering {
namespace {

using std::chrono::seconds;

constexpr std::ptrdiff_t kDaysAround = 14;
constexpr std::size_t kNotesMax = 100;

std::vector<double> lengths_h(std::span<const CounterBooking> pieces) {
  std::vector<double> lengths;
  for (const CounterBooking& piece : pieces) lengths.push_back(in_hours(piece.span.length()));
  return lengths;
}

/// Expected energies of the pieces, kWh.
std::vector<double> shaped_by(const LoadShape& shape, std::span<const CounterBooking> pieces,
                              seconds interval) {
  std::vector<double> expected = lengths_h(pieces);
  for (std::size_t i = 0; i < expected.size(); ++i) {
    expected[i] *= std::max(0.0, shape(interval_start(pieces[i].span.begin, interval)));
  }
  return expected;
}

/// Cuts a booking at the interval boundaries; energies follow the shape and add up
/// to the booking's.
std::vector<CounterBooking> cut(const CounterBooking& booking, const BookingRules& rules,
                                const LoadShape& shape) {
  std::vector<CounterBooking> pieces;
  for (Instant begin = booking.span.begin; begin < booking.span.end;) {
    const Instant slot = interval_start(begin, rules.interval);
    const Instant end = std::min(slot + rules.interval, booking.span.end);
    CounterBooking piece = booking;
    piece.span = {begin, end};
    pieces.push_back(piece);
    begin = end;
  }
  // Between close samples the load is taken as constant; across a hole it is estimated.
  const bool is_hole = pieces.size() > 1 && booking.span.length() > rules.sample_gap_max;
  std::vector<double> weights = lengths_h(pieces);
  if (is_hole && shape) {
    const std::vector<double> shaped = shaped_by(shape, pieces, rules.interval);
    const double sum = std::accumulate(shaped.begin(), shaped.end(), 0.0);
    if (std::isfinite(sum) && sum > 0.0) weights = shaped;
  }
  const double whole = std::accumulate(weights.begin(), weights.end(), 0.0);
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    pieces[i].energy_kWh = booking.energy_kWh * weights[i] / whole;
    if (is_hole && pieces[i].validity == Validity::ok) pieces[i].validity = Validity::scaled;
  }
  return pieces;
}

Reading reading_of(std::span<const CounterBooking> pieces, std::uint32_t meter,
                   const TimeSpan& interval) {
  Reading reading{meter, interval.begin, kAbsent, Validity::missing};
  seconds covered{0};
  double energy_kWh = 0.0;
  bool is_missing = false;
  bool is_estimated = false;
  bool is_doubted = false;
  for (const CounterBooking& piece : pieces) {
    reading.reasons |= piece.reasons;
    covered += piece.span.length();
    is_missing = is_missing || piece.validity == Validity::missing;
    is_estimated = is_estimated || piece.validity == Validity::scaled;
    is_doubted = is_doubted || piece.validity == Validity::suspect;
    energy_kWh += piece.energy_kWh;
  }
  // What was forgotten of an interval in doubt makes it no less doubtful.
  if (is_missing || (covered < interval.length() && !is_doubted)) return reading;
  reading.mean_kW = energy_kWh / in_hours(interval.length());
  reading.validity = is_estimated ? Validity::scaled : Validity::ok;
  if (is_doubted) reading.validity = Validity::suspect;
  return reading;
}

/// Withdraws what a booking corrects, so that its intervals are formed again.
void withdraw(IntervalBook& book, const CounterBooking& booking, seconds interval) {
  std::erase_if(book.pieces, [&](const CounterBooking& piece) {
    return piece.span.begin >= booking.span.begin;
  });
  if (book.next) book.next = std::min(*book.next, interval_start(booking.span.begin, interval));
}

/// Forgets completed intervals, except the start of one that may still be withdrawn.
void forget(IntervalBook& book, const CounterState& counter, seconds interval) {
  const auto is_before = [&](const CounterBooking& piece, Instant t) {
    return piece.span.begin >= interval_start(t, interval) && piece.span.end <= t;
  };
  const auto may_return = [&](const CounterBooking& piece) {
    if (counter.previous && is_before(piece, counter.previous->sample.time)) return true;
    return counter.stands_since && is_before(piece, *counter.stands_since);
  };
  std::erase_if(book.pieces, [&](const CounterBooking& piece) {
    return piece.span.end <= *book.next && !may_return(piece);
  });
}

/// The mean of the measurements at that time of day on the days around, or of the whole record
/// if there are none.
/// @param record  Without holes, each one interval after the last. @pre it outlives the shape.
LoadShape like_days_around(std::span<const Reading> record, seconds interval) {
  double sum_kW = 0.0;
  int measured = 0;
  for (const Reading& reading : record) {
    if (reading.validity != Validity::ok) continue;
    sum_kW += reading.mean_kW;
    ++measured;
  }
  const double usual_kW = measured > 0 ? sum_kW / measured : 0.0;
  return [record, interval, usual_kW](Instant start) {
    const std::ptrdiff_t here = (start - record.front().start) / interval;
    const std::ptrdiff_t day = kDay / interval;
    double around_kW = 0.0;
    int found = 0;
    for (std::ptrdiff_t k = -kDaysAround; k <= kDaysAround; ++k) {
      const std::ptrdiff_t i = here + k * day;
      if (i < 0 || i >= std::ssize(record)) continue;
      const Reading& reading = record[static_cast<std::size_t>(i)];
      if (reading.validity != Validity::ok) continue;
      around_kW += reading.mean_kW;
      ++found;
    }
    return found > 0 ? around_kW / found : usual_kW;
  };
}

/// A recorded register, and how it is read.
struct Recorded {
  std::span<const RegisterSample> samples;
  BookingRules rules;
  const CounterSettings& settings;
  const ResetTimes& resets;
};

void note_event(const CounterStep& step, const CounterState& before, const RegisterSample& sample,
                std::vector<RegisterNote>& notes) {
  if (step.event == CounterEvent::none || notes.size() == kNotesMax) return;
  notes.push_back({step.event, before.baseline, before.pending ? before.pending->first : sample});
}

std::vector<Reading> booked_readings(std::uint32_t meter, const Recorded& recorded,
                                     const LoadShape& shape, std::vector<RegisterNote>* notes) {
  std::vector<Reading> readings;
  CounterStep step;
  IntervalBook book;
  for (const RegisterSample& sample : recorded.samples) {
    const CounterState before = notes != nullptr ? step.state : CounterState{};
    const auto zeroed =
        recorded.resets ? std::optional{recorded.resets(sample.time)} : std::nullopt;
    step = advance(std::move(step.state), sample, recorded.settings, zeroed);
    if (notes != nullptr) note_event(step, before, sample, *notes);
    for (const BookedInterval& booked : book_intervals(book, meter, step, recorded.rules, shape)) {
      while (booked.supersedes && !readings.empty() &&
             readings.back().start >= booked.reading.start) {
        readings.pop_back();
      }
      readings.push_back(booked.reading);
    }
  }
  return readings;
}

}  // namespace

std::vector<BookedInterval> book_intervals(IntervalBook& book, std::uint32_t meter,
                                           const CounterStep& step, const BookingRules& rules,
                                           const LoadShape& shape) {
  std::vector<BookedInterval> intervals;
  for (const CounterBooking& booking : step.bookings) {
    if (booking.supersedes) withdraw(book, booking, rules.interval);
    if (!book.next) {
      const Instant start = interval_start(booking.span.begin, rules.interval);
      // The interval that contains the first sample can never be complete.
      book.next = start == booking.span.begin ? start : start + rules.interval;
    }
    const std::vector<CounterBooking> pieces = cut(booking, rules, shape);
    book.pieces.insert(book.pieces.end(), pieces.begin(), pieces.end());
    auto first = book.pieces.begin();
    for (; *book.next + rules.interval <= booking.span.end; *book.next += rules.interval) {
      const TimeSpan interval{*book.next, *book.next + rules.interval};
      const auto lies_before = [&](Instant t) {
        return [t](const CounterBooking& piece) { return piece.span.begin < t; };
      };
      first = std::partition_point(first, book.pieces.end(), lies_before(interval.begin));
      const auto last = std::partition_point(first, book.pieces.end(), lies_before(interval.end));
      intervals.push_back({reading_of({first, last}, meter, interval), booking.supersedes});
    }
  }
  if (book.next) forget(book, step.state, rules.interval);
  return intervals;
}

std::vector<Reading> readings_from_register(std::uint32_t meter,
                                            std::span<const RegisterSample> samples,
                                            seconds interval, const CounterSettings& settings,
                                            const ResetTimes& resets,
                                            std::vector<RegisterNote>* notes) {
  // Stamps that are set when something was read are late by now and then.
  const BookingRules rules{.interval = interval, .sample_gap_max = interval + interval / 4};
  const Recorded recorded{samples, rules, settings, resets};
  std::vector<Reading> evenly = booked_readings(meter, recorded, {}, notes);
  const bool any_hole = std::any_of(evenly.begin(), evenly.end(), [](const Reading& reading) {
    return reading.validity == Validity::scaled;
  });
  if (!any_hole) return evenly;
  return booked_readings(meter, recorded, like_days_around(evenly, interval), nullptr);
}

}  // namespace recald::metering
