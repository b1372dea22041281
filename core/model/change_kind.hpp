/// What is done to a quantity of a building: by a measure, or by a parameter of a client's model.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

namespace recald::model {

enum class ChangeKind : std::uint8_t {
  set,    ///< To this value.
  scale,  ///< Times this factor.
  add,    ///< More by this; less where it is negative.
};

/// In files, in the order of `ChangeKind`.
inline constexpr std::array<std::string_view, 3> kChangeKindNames{"set", "scale", "add"};

/// A quantity after a change. All in the quantity's unit, but for the factor of `scale`.
[[nodiscard]] constexpr double changed(ChangeKind kind, double before, double by) {
  switch (kind) {
    case ChangeKind::set:
      return by;
    case ChangeKind::scale:
      return before * by;
    case ChangeKind::add:
      break;
  }
  return before + by;
}

}  // namespace recald::model
