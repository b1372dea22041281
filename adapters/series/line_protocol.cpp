#include "adapters/series/line_protocol.hpp"

#include <fmt/format.h>

#include <chrono>
#include <cmath>
#include <iterator>
#include <string_view>

namespace recald::series {
namespace {

void add_value(std::string& line, std::string_view value) {
  for (const char c : value) {
    const auto byte = static_cast<unsigned char>(c);
    if (c == ',' || c == '=' || c == ' ') line += '\\';
    if (byte < 0x20 || byte == 0x7F) {
      line += "\\ ";
    } else {
      line += c == '\\' ? '/' : c;
    }
  }
}

std::string fields_of(const Point& point) {
  std::string fields;
  for (const Field& field : point.fields) {
    if (!std::isfinite(field.value)) continue;
    fmt::format_to(std::back_inserter(fields), "{}{}={}", fields.empty() ? "" : ",", field.name,
                   field.value);
  }
  return fields;
}

}  // namespace

std::string line_protocol(std::span<const Point> points) {
  std::string lines;
  for (const Point& point : points) {
    const std::string fields = fields_of(point);
    if (fields.empty()) continue;
    lines += point.measurement;
    for (const auto& [name, value] : point.labels) {
      if (value.empty()) continue;
      lines += ',' + name + '=';
      add_value(lines, value);
    }
    const std::chrono::nanoseconds time{point.time.time_since_epoch()};
    fmt::format_to(std::back_inserter(lines), " {} {}\n", fields, time.count());
  }
  return lines;
}

}  // namespace recald::series
