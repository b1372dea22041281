/// The events that alerts may be about.
#pragma once

#include <span>
#include <string_view>

namespace recald::daemon {

struct AlertKind {
  std::string_view kind;   ///< Of the event.
  std::string_view title;  ///< What a person reads first.
  bool is_usual;           ///< Told of unless the site file chooses others.
};

[[nodiscard]] std::span<const AlertKind> alert_kinds();

/// Null for an event that no alert is about.
[[nodiscard]] const AlertKind* find_alert_kind(std::string_view kind);

}  // namespace recald::daemon
