#include "daemon/site/config/service/alert_kinds.hpp"

#include <algorithm>
#include <array>

namespace recald::daemon {
namespace {

constexpr std::array kKinds{
    AlertKind{"drift_alarm", "The building behaves differently", true},
    AlertKind{"cause_named", "A likely cause was found", true},
    AlertKind{"meter_silent", "A meter is silent", true},
    AlertKind{"meter_answers", "A meter answers again", true},
    AlertKind{"weather_silent", "A weather sensor is silent", true},
    AlertKind{"weather_answers", "A weather sensor answers again", true},
    AlertKind{"counter_state_lost", "A counter had to begin anew", true},
    AlertKind{"unforeseen", "Something unforeseen happened", true},
    AlertKind{"alert_not_sent", "An alert could not be sent", false},
    AlertKind{"alert_refused", "An alert was refused", false},
    AlertKind{"forward_failed", "Results cannot be sent on", false},
    AlertKind{"forward_refused", "Some results are refused where they are sent", false},
    AlertKind{"forward_anew", "Everything is sent to the fleet again", false},
    AlertKind{"weather_frozen", "A weather sensor stands still", false},
    AlertKind{"calibration_rejected", "A calibration was not accepted", true},
    AlertKind{"calibration_failed", "A calibration failed", true},
    AlertKind{"diagnosis_failed", "A diagnosis failed", true},
    AlertKind{"store_refuses", "Readings cannot be stored", true},
    AlertKind{"store_accepts", "Readings are stored again", true},
    AlertKind{"no_store", "The store cannot be opened", true},
    AlertKind{"store_recovered", "The store was damaged and recovered", true},
    AlertKind{"store_damaged", "The store is damaged", true},
    AlertKind{"backup_failed", "There is no new backup", true},
    AlertKind{"not_reloaded", "The site file was rejected", false},
    AlertKind{"not_recorded", "Nothing is recorded", false},
    AlertKind{"recording_ended", "The recording has ended", false},
    AlertKind{"month_not_closed", "A month could not be closed", false},
    AlertKind{"counter_reset", "A counter was reset", false},
    AlertKind{"counter_stuck", "A counter stands still", false},
    AlertKind{"counter_no_total", "A counter goes back again and again", false},
    AlertKind{"counter_absent", "A counter seems to have no value", false},
    AlertKind{"power_differs", "A meter contradicts itself", false},
    AlertKind{"clock_set", "The clock was set", false},
};

}  // namespace

std::span<const AlertKind> alert_kinds() { return kKinds; }

const AlertKind* find_alert_kind(std::string_view kind) {
  const auto found = std::ranges::find(kKinds, kind, &AlertKind::kind);
  return found == kKinds.end() ? nullptr : &*found;
}

}  // namespace recald::daemon
