#include "daemon/commands/meters/scan_bus.hpp"

#include <fmt/format.h>

#include <charconv>

namespace recald::daemon {
namespace {

using modbus::Function;
using modbus::ReadFault;
using std::chrono::milliseconds;

constexpr int kUnitMax = 247;
/// Most units of a scan are silent, and each costs this twice.
constexpr milliseconds kScanTimeout{400};

class Scan {
 public:
  explicit Scan(const BusConfig& bus)
      : timeout_(bus.timeout > milliseconds{0} ? bus.timeout : kScanTimeout), access_(bus) {}

  /// @return the unit, if it answers.
  std::optional<FoundUnit> look_at(int number) {
    const auto unit = static_cast<std::uint8_t>(number);
    FoundUnit found{.unit = number};
    found.holding_registers = probe(unit, Function::read_holding_registers);
    if (ended_by_) return {};
    found.input_registers = probe(unit, Function::read_input_registers);
    if (ended_by_ || (found.holding_registers.empty() && found.input_registers.empty())) return {};
    if (!found.holding_registers.empty()) found.models = walk(unit);
    access_.pause();
    if (auto identity = access_.connection().identify(unit, timeout_)) {
      found.identity = std::move(*identity);
    }
    return found;
  }

  [[nodiscard]] const std::optional<std::string>& ended_by() const { return ended_by_; }

 private:
  /// "yes", or the exception; empty where nobody answers.
  std::string probe(std::uint8_t unit, Function function) {
    const auto result = access_.ask({unit, function, 0, 1}, timeout_).result;
    if (result) return "yes";
    const modbus::ReadFailure& failure = result.error();
    if (failure.fault == ReadFault::refused) ended_by_ = failure.what;
    // A gateway says so for a unit that it cannot reach.
    const bool is_from_gateway = failure.exception_code == 0x0A || failure.exception_code == 0x0B;
    if (failure.fault != ReadFault::exception || is_from_gateway) return "";
    return "exception " + modbus::describe_exception(failure.exception_code);
  }

  std::vector<modbus::SunSpecModel> walk(std::uint8_t unit) {
    modbus::SunSpecWalk walk{unit, {}};
    while (const auto request = walk.next()) walk.take(access_.ask(*request, timeout_).result);
    return walk.models();
  }

  milliseconds timeout_;
  BusAccess access_;
  std::optional<std::string> ended_by_;
};

std::optional<int> parse_unit(std::string_view text) {
  int unit = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), unit);
  if (error != std::errc{} || end != text.data() + text.size()) return {};
  if (unit < 1 || unit > kUnitMax) return {};
  return unit;
}

}  // namespace

Result<UnitRange> parse_units(std::string_view text) {
  const std::size_t dash = text.find('-');
  const auto first = parse_unit(text.substr(0, dash));
  const auto last = dash == std::string_view::npos ? first : parse_unit(text.substr(dash + 1));
  if (first && last && *first <= *last) return UnitRange{*first, *last};
  return failure(ErrorCode::invalid_value,
                 fmt::format("--units is '{}'; write one Modbus address or two with a dash, from 1 "
                             "to {}, such as 1-32",
                             text, kUnitMax));
}

BusScan scan_bus(const BusConfig& bus, const UnitRange& units,
                 const std::function<void(int, std::size_t)>& report) {
  BusScan result;
  Scan scan{bus};
  for (int unit = units.first; unit <= units.last; ++unit) {
    report(unit, result.found.size());
    if (auto found = scan.look_at(unit)) result.found.push_back(std::move(*found));
    if (scan.ended_by()) {
      result.ended_by = scan.ended_by();
      break;
    }
  }
  return result;
}

}  // namespace recald::daemon
