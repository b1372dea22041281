#include "simulators/feed/faults.hpp"

#include <algorithm>
#include <cmath>

namespace recald::simulators {
namespace {

constexpr double kFaultSlotsPerHour = 4.0;
constexpr double kSlotsPerYear = 365.25 * 24.0 * kFaultSlotsPerHour;
constexpr std::size_t kFirstPossible = 48;

/// Keeps faults apart, with a good reading between any two, so that each remains as declared.
class Agenda {
 public:
  explicit Agenda(std::size_t slots) : taken_(slots, false) {}

  void place(FaultKind kind, std::size_t count, Rng& rng) {
    if (count + kFirstPossible + 2 > taken_.size()) return;
    // In a year full of faults there may be no room; a bounded number of tries is enough.
    for (int attempt = 0; attempt < 50; ++attempt) {
      const std::size_t first =
          kFirstPossible + rng.below(taken_.size() - count - kFirstPossible - 1);
      const auto from = taken_.begin() + static_cast<std::ptrdiff_t>(first) - 1;
      const auto to = from + static_cast<std::ptrdiff_t>(count) + 2;
      if (std::find(from, to, true) != to) continue;
      std::fill(from + 1, to - 1, true);
      faults_.push_back({kind, first, count});
      return;
    }
  }

  [[nodiscard]] std::vector<Fault> ordered() && {
    std::ranges::sort(faults_, {}, &Fault::first);
    return std::move(faults_);
  }

 private:
  std::vector<bool> taken_;
  std::vector<Fault> faults_;
};

std::size_t draw_count(const FaultHabit& habit, Rng& rng) {
  const double u = rng.uniform();
  const double hours = habit.shortest_h + (habit.longest_h - habit.shortest_h) * u * u;
  return std::max<std::size_t>(1,
                               static_cast<std::size_t>(std::lround(hours * kFaultSlotsPerHour)));
}

}  // namespace

std::string_view to_string(FaultKind kind) {
  switch (kind) {
    case FaultKind::gap:
      return "gap";
    case FaultKind::blank:
      return "blank";
    case FaultKind::stuck:
      return "stuck";
    case FaultKind::zero:
      return "zero";
    case FaultKind::spike:
      return "spike";
    case FaultKind::negative:
      return "negative";
  }
  return "";
}

std::vector<FaultHabit> healthy_habits() {
  return {{FaultKind::gap, 4.0, 1.0, 60.0},    {FaultKind::gap, 14.0, 0.25, 0.75},
          {FaultKind::blank, 6.0, 0.25, 3.0},  {FaultKind::stuck, 2.0, 5.0, 16.0},
          {FaultKind::spike, 3.0, 0.25, 0.25}, {FaultKind::negative, 0.7, 0.25, 0.5}};
}

std::vector<FaultHabit> steam_pit_habits() {
  return {{FaultKind::gap, 12.0, 6.0, 120.0},    {FaultKind::gap, 60.0, 0.25, 2.0},
          {FaultKind::blank, 25.0, 0.25, 6.0},   {FaultKind::stuck, 13.0, 6.0, 90.0},
          {FaultKind::zero, 13.0, 8.0, 60.0},    {FaultKind::spike, 60.0, 0.25, 0.5},
          {FaultKind::negative, 25.0, 0.25, 2.0}};
}

std::vector<FaultHabit> gap_habits() {
  return {{FaultKind::gap, 19.0, 2.0, 60.0}, {FaultKind::gap, 30.0, 0.25, 1.5}};
}

std::vector<FaultHabit> weather_station_habits() {
  return {{FaultKind::gap, 5.0, 0.25, 9.0}, {FaultKind::blank, 3.0, 0.5, 5.0}};
}

std::vector<Fault> plan_faults(const std::vector<FaultHabit>& habits, int lost_months,
                               std::size_t slots, Rng& rng) {
  Agenda agenda(slots);
  for (int i = 0; i < lost_months; ++i) {
    const double days = rng.uniform(17.0, 27.0);
    agenda.place(FaultKind::gap, static_cast<std::size_t>(days * 24.0 * kFaultSlotsPerHour), rng);
  }
  for (const FaultHabit& habit : habits) {
    const double expected = habit.per_year * static_cast<double>(slots) / kSlotsPerYear;
    for (double at = draw_waiting_time(rng, 1.0); at < expected;
         at += draw_waiting_time(rng, 1.0)) {
      agenda.place(habit.kind, draw_count(habit, rng), rng);
    }
  }
  return std::move(agenda).ordered();
}

}  // namespace recald::simulators
