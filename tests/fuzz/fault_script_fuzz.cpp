// A script that is accepted, written line by line, is the same script; each wrong line is named.
#include <charconv>
#include <sstream>

#include "simulators/devices/fault_script.hpp"
#include "tests/fuzz/require.hpp"

namespace recald::fuzz {
namespace {

using simulators::DeviceFaultKind;
using simulators::FaultScript;
using simulators::ScriptedFault;

std::string_view name_of(DeviceFaultKind kind) {
  switch (kind) {
    case DeviceFaultKind::silent:
      return "silent";
    case DeviceFaultKind::late:
      return "late";
    case DeviceFaultKind::split:
      return "split";
    case DeviceFaultKind::wrong_unit:
      return "wrong_unit";
    case DeviceFaultKind::wrong_length:
      return "wrong_length";
    case DeviceFaultKind::wrong_count:
      return "wrong_count";
    case DeviceFaultKind::exception:
      return "exception";
    case DeviceFaultKind::flip:
      return "flip";
    case DeviceFaultKind::reset:
      return "reset";
    case DeviceFaultKind::hold:
      return "register";
    case DeviceFaultKind::refuse:
      return "refuse";
  }
  give_up("a fault has a kind");
}

std::string amount_of(const ScriptedFault& fault) {
  if (fault.kind == DeviceFaultKind::silent || fault.kind == DeviceFaultKind::refuse) return "";
  char text[32];
  const char* end = std::to_chars(text, text + sizeof text, fault.amount).ptr;
  const bool is_wait = fault.kind == DeviceFaultKind::late || fault.kind == DeviceFaultKind::split;
  return " " + std::string(text, static_cast<std::size_t>(end - text)) + (is_wait ? "ms" : "");
}

std::string written(const FaultScript& script) {
  std::string text;
  for (const ScriptedFault& fault : script.faults) {
    const auto ms = [](std::chrono::milliseconds t) { return std::to_string(t.count()) + "ms"; };
    text += fault.kind == DeviceFaultKind::reset ? "at " + ms(fault.begin)
                                                 : ms(fault.begin) + ".." + ms(fault.end);
    text += fault.unit ? " unit " + std::to_string(*fault.unit) : " all";
    text += " " + std::string{name_of(fault.kind)} + amount_of(fault) + "\n";
  }
  return text;
}

bool is_same(const ScriptedFault& a, const ScriptedFault& b) {
  return a.begin == b.begin && a.end == b.end && a.unit == b.unit && a.kind == b.kind &&
         a.amount == b.amount;
}

}  // namespace
}  // namespace recald::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace recald::fuzz;
  const auto script = recald::simulators::parse_fault_script(text_of(data, size));
  if (!script) {
    std::istringstream lines{script.error().message};
    for (std::string line; std::getline(lines, line);) {
      require_sentence(line);
      require(line.starts_with("line "), "a problem says where");
    }
    return 0;
  }
  const auto again = recald::simulators::parse_fault_script(written(*script));
  require(again.has_value(), "what was written is a script");
  require(again->faults.size() == script->faults.size(), "of as many faults");
  for (std::size_t i = 0; i < script->faults.size(); ++i) {
    require(script->faults[i].begin < script->faults[i].end, "a fault begins before it ends");
    require(is_same(script->faults[i], again->faults[i]), "and the same ones");
  }
  return 0;
}
