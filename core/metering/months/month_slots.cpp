#include "core/metering/months/month_slots.hpp"

#include <cassert>

#include "core/absent.hpp"

namespace recald::metering {
namespace {

using std::chrono::seconds;

}  // namespace

MonthGrid::MonthGrid(const LocalCalendar& calendar, Month month, seconds interval, seconds phase)
    : month_{month},
      interval_{interval},
      phase_{phase},
      month_span_{calendar.month_span(month)},
      first_{month_span_.begin} {
  assert(interval >= seconds{60} && kDay % interval == seconds{0});
  assert(seconds{0} <= phase && phase < interval);
  const seconds past = (month_span_.begin.time_since_epoch() - phase) % interval;
  if (past != seconds{0}) first_ += interval - past;

  const auto expected = static_cast<std::size_t>(month_span_.length() / interval) + 1;
  time_of_day_.reserve(expected);
  day_.reserve(expected);
  for (Instant t = first_; t < month_span_.end;) {
    const LocalTime local = calendar.local_time(t);
    const auto time_of_day = static_cast<int>(std::chrono::minutes{local.minute_of_day} / interval);
    // A day that begins here and ends with the same offset is plain: one calendar
    // look-up is enough.
    const bool plain = time_of_day == 0 && t + kDay <= month_span_.end &&
                       calendar.utc_offset(t) == calendar.utc_offset(t + kDay - interval);
    const int count = plain ? times_of_day() : 1;
    for (int i = 0; i < count; ++i, t += interval) {
      time_of_day_.push_back(static_cast<std::uint16_t>(time_of_day + i));
      day_.push_back(static_cast<std::uint8_t>(static_cast<unsigned>(local.date.day()) - 1));
    }
  }
  find_day_begins();
}

void MonthGrid::find_day_begins() {
  for (int day = 0, slot = 0; day <= days(); ++day) {
    while (slot < slots() && this->day(slot) < day) ++slot;
    day_begins_.push_back(slot);
  }
}

int MonthGrid::times_of_day() const { return static_cast<int>(kDay / interval_); }

MonthSlots::MonthSlots(std::shared_ptr<const MonthGrid> month_grid) : grid{std::move(month_grid)} {
  const auto n = static_cast<std::size_t>(grid->slots());
  constexpr double nan = kAbsent;
  measured_kW.assign(n, nan);
  used_kW.assign(n, nan);
  validity.assign(n, Validity::missing);
  reasons.assign(n, Reason::none);
  method.assign(n, FillMethod::none);
  late.assign(n, 0);
}

}  // namespace recald::metering
