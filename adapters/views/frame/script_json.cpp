#include "adapters/views/frame/script_json.hpp"

#include <charconv>
#include <cmath>

namespace recald::views {

using nlohmann::json;

json json_number(double value, int significant_digits) {
  if (!std::isfinite(value)) return nullptr;
  char buffer[32];
  const auto written = std::to_chars(buffer, buffer + sizeof buffer, value,
                                     std::chars_format::scientific, significant_digits - 1);
  double rounded = 0.0;
  std::from_chars(buffer, written.ptr, rounded);
  return rounded;
}

std::string script_safe_text(const json& data) {
  const std::string text = data.dump(-1, ' ', false, json::error_handler_t::replace);
  std::string safe;
  safe.reserve(text.size());
  for (const char c : text) {
    if (c == '<') {
      safe += "\\u003c";  // "<" occurs in JSON only inside strings.
    } else {
      safe += c;
    }
  }
  return safe;
}

}  // namespace recald::views
