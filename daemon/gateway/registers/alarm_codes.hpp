/// Numbers of causes, as a management system knows them.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>

#include "core/drift/alarm_kinds.hpp"

namespace recald::daemon {

/// A number is given once and keeps its meaning in all versions; that of a cause that is no longer
/// known stays unused. Effects of the catalogue are numbered from 100 on, in `effect_codes`.
enum class AlarmCode : std::uint16_t {
  none = 0,
  nothing = 1,
  parameter = 2,
  use = 3,
  meter = 4,
  unknown = 5,
};

struct EffectCode {
  std::string_view effect;  ///< Id in the catalogue.
  std::uint16_t number;
};

[[nodiscard]] std::span<const EffectCode> effect_codes();

/// @param subject  Of an effect, its id. One without a number is `unknown`.
[[nodiscard]] AlarmCode alarm_code(drift::CauseKind kind, std::string_view subject);

}  // namespace recald::daemon
