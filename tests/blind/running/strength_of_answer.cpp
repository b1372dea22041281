#include "tests/blind/running/strength_of_answer.hpp"

#include <algorithm>
#include <array>

namespace recald::blind {
namespace {

// Left is the catalogue's parameter, right how the hidden effects state their strengths. A clock
// that is fast by an hour shows at ten what happened at nine: y(t - 1 h).
constexpr std::array<StrengthOfAnswer, 14> kStrengths{{
    {"after_hours", "late_stop", 1.0, 0.0, "hours later than planned, on an average working day"},
    {"clock_offset", "offset", -60.0, 0.0, "minutes fast, negative for slow"},
    {"constant_speed_fans", "constant_share", 1.0, 0.0, "share of the fans that do not slow down"},
    {"economiser_changeover", "shift", 1.0, 0.0,
     "K that the change-over is too high, negative for too low"},
    {"economiser_failed", "failed_share", 1.0, 0.0, "share of the free cooling that is lost"},
    {"night_setback_missing", "missing_share", 1.0, 0.0, "share of the set-back that is missing"},
    {"outdoor_air_amount", "change", 1.0, 0.0, "share added to the designed outdoor air"},
    {"phase_lost", "lost_share", 1.0, 0.0, "share lost"},
    {"plug_growth", "growth", 1.0, 0.0, "share a year, negative for shrinking"},
    {"round_the_clock_zone", "floor_share", 1.0, 0.0, "share of the floor that never closes"},
    {"scale_fault", "scale", 1.0, -1.0, "share above what is right, negative for below"},
    {"semester_calendar", "absent_share", 1.0, 0.0, "share of the people who follow the terms"},
    {"thermal_mass", "mass_factor", 1.0, -1.0, "share of the heat capacity, negative for less"},
    {"vacancy", "absent_share", 1.0, 0.0, "share of the people who stay away"},
}};

}  // namespace

const StrengthOfAnswer* strength_of_answer(std::string_view effect) {
  const auto* found = std::ranges::find(kStrengths, effect, &StrengthOfAnswer::effect);
  return found == kStrengths.end() ? nullptr : &*found;
}

}  // namespace recald::blind
