#include "simulators/devices/fault_script.hpp"

#include <fmt/format.h>

#include <array>
#include <charconv>
#include <cmath>
#include <sstream>
#include <utility>

namespace recald::simulators {
namespace {

using std::chrono::milliseconds;

struct KindName {
  std::string_view name;
  DeviceFaultKind kind;
  std::string_view amount_unit;  ///< "ms": a wait; "#": a number; empty: none.
  double amount_max = 0.0;       ///< For a number: the room in the frame, or kWh.
};

constexpr double kAmountMax = 1e12;  ///< For any number: more kWh than a meter counts.
constexpr double kFrameBits = 8.0 * 260.0;

constexpr std::array<KindName, 11> kKinds{
    {{"silent", DeviceFaultKind::silent, ""},
     {"late", DeviceFaultKind::late, "ms"},
     {"split", DeviceFaultKind::split, "ms"},
     {"wrong_unit", DeviceFaultKind::wrong_unit, "#", 255.0},
     {"wrong_length", DeviceFaultKind::wrong_length, "#", 65'535.0},
     {"wrong_count", DeviceFaultKind::wrong_count, "#", 255.0},
     {"exception", DeviceFaultKind::exception, "#", 255.0},
     {"flip", DeviceFaultKind::flip, "#", kFrameBits - 1.0},
     {"reset", DeviceFaultKind::reset, "#", kAmountMax},
     {"register", DeviceFaultKind::hold, "#", kAmountMax},
     {"refuse", DeviceFaultKind::refuse, ""}}};

std::optional<double> parse_number(std::string_view text) {
  double value = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size()) return {};
  if (!(value >= 0.0 && value <= kAmountMax)) return {};
  return value;
}

constexpr double kTimeMax_ms = 3.6e6 * 24.0 * 366.0 * 20.0;  ///< Twenty years.

/// "90s", "5m", "2h", "800ms".
std::optional<milliseconds> parse_time(std::string_view text) {
  constexpr std::array<std::pair<std::string_view, double>, 4> kUnits{
      {{"ms", 1.0}, {"s", 1e3}, {"m", 6e4}, {"h", 3.6e6}}};
  for (const auto& [unit, length_ms] : kUnits) {
    if (!text.ends_with(unit)) continue;
    const auto count = parse_number(text.substr(0, text.size() - unit.size()));
    if (!count || *count * length_ms > kTimeMax_ms) continue;
    return milliseconds{static_cast<std::int64_t>(*count * length_ms)};
  }
  return {};
}

/// Takes the words of one line one after the other.
class Words {
 public:
  explicit Words(const std::string& line) : in_(line) {}
  std::string next() {
    std::string word;
    in_ >> word;
    return word;
  }

 private:
  std::istringstream in_;
};

Result<ScriptedFault> parse_line(const std::string& line) {
  const auto wrong = [](std::string what) {
    return failure(ErrorCode::malformed, std::move(what));
  };
  Words words{line};
  ScriptedFault fault{};
  std::string when = words.next();
  if (when == "at") {
    when = words.next();
    const auto t = parse_time(when);
    if (!t) return wrong(fmt::format("'{}' is no time such as 90s or 5m", when));
    fault.begin = *t;
    fault.end = milliseconds::max();
  } else {
    const std::size_t dots = when.find("..");
    const auto begin = parse_time(when.substr(0, dots));
    const auto end = dots == std::string::npos
                         ? std::nullopt
                         : parse_time(std::string_view{when}.substr(dots + 2));
    if (!begin || !end || *end <= *begin) {
      return wrong(fmt::format("'{}' is no span such as 1m..5m, nor 'at' and a time", when));
    }
    fault.begin = *begin;
    fault.end = *end;
  }
  if (const std::string whom = words.next(); whom == "unit") {
    const std::string number = words.next();
    const auto unit = parse_number(number);
    if (!unit || *unit > 255.0 || *unit != std::floor(*unit))
      return wrong(fmt::format("'{}' is no unit, 0 to 255", number));
    fault.unit = static_cast<int>(*unit);
  } else if (whom != "all") {
    return wrong(fmt::format("'{}' is neither 'unit' and a number nor 'all'", whom));
  }
  const std::string name = words.next();
  for (const KindName& kind : kKinds) {
    if (kind.name != name) continue;
    fault.kind = kind.kind;
    const bool is_event = kind.kind == DeviceFaultKind::reset;
    if (is_event != (fault.end == milliseconds::max())) {
      return wrong(is_event ? "a reset happens 'at' a time"
                            : fmt::format("'{}' lasts from..to", name));
    }
    const std::string amount = words.next();
    if (kind.amount_unit == "ms") {
      const auto wait = parse_time(amount);
      if (!wait) return wrong(fmt::format("'{}' needs a wait such as 800ms", name));
      fault.amount = static_cast<double>(wait->count());
    } else if (kind.amount_unit == "#") {
      const auto number = parse_number(amount);
      if (!number || *number > kind.amount_max) {
        return wrong(fmt::format("'{}' needs a number from 0 to {}", name, kind.amount_max));
      }
      fault.amount = *number;
    } else if (!amount.empty()) {
      return wrong(fmt::format("'{}' needs nothing after it, and '{}' stands there", name, amount));
    }
    if (const std::string more = words.next(); !more.empty()) {
      return wrong(fmt::format("'{}' is one word too many", more));
    }
    return fault;
  }
  return wrong(fmt::format("'{}' is no disturbance that is known", name));
}

}  // namespace

std::vector<ScriptedFault> FaultScript::at(milliseconds t, int unit) const {
  std::vector<ScriptedFault> in_force;
  for (const ScriptedFault& fault : faults) {
    if (t < fault.begin || t >= fault.end) continue;
    if (!fault.unit || *fault.unit == unit) in_force.push_back(fault);
  }
  return in_force;
}

Result<FaultScript> parse_fault_script(std::string_view text) {
  FaultScript script;
  std::string problems;
  std::istringstream lines{std::string{text}};
  int number = 0;
  for (std::string line; std::getline(lines, line);) {
    ++number;
    line = line.substr(0, line.find('#'));
    if (line.find_first_not_of(" \t\r") == std::string::npos) continue;
    const auto fault = parse_line(line);
    if (fault) {
      script.faults.push_back(*fault);
    } else {
      problems +=
          fmt::format("{}line {}: {}", problems.empty() ? "" : "; ", number, fault.error().message);
    }
  }
  if (!problems.empty()) return failure(ErrorCode::malformed, problems);
  return script;
}

}  // namespace recald::simulators
