/// Numbers in results: JSON has no NaN, so what nobody knows is null.
#pragma once

#include <cmath>
#include <nlohmann/json.hpp>

namespace recald::daemon {

[[nodiscard]] inline nlohmann::ordered_json json_number(double value) {
  return std::isfinite(value) ? nlohmann::ordered_json(value) : nlohmann::ordered_json(nullptr);
}

}  // namespace recald::daemon
