#include <fmt/format.h>
#include <unistd.h>

#include <array>

#include "adapters/energyplus/run/program.hpp"
#include "adapters/system/clock_setting.hpp"
#include "adapters/system/machine.hpp"
#include "adapters/system/time_zone_release.hpp"
#include "adapters/versions/library_versions.hpp"
#include "daemon/commands/commit.hpp"
#include "daemon/commands/doctor/facts.hpp"
#include "daemon/version.hpp"

namespace recald::daemon {
namespace {

Fact program() { return {"recald", kVersion}; }

Fact build() {
  const std::string_view commit = built_commit();
  return {"build",
          fmt::format("{}, {}, {}", *kBuildType == '\0' ? "no type" : kBuildType,
#ifdef __clang__
                      "clang " __clang_version__,
#else
                      "GCC " __VERSION__,
#endif
                      commit.empty() ? "unknown commit" : fmt::format("commit {}", commit))};
}

Fact libraries() {
  std::string list;
  for (const LibraryVersion& one : library_versions()) {
    list += fmt::format("{}{} {}", list.empty() ? "" : ", ", one.name, one.version);
  }
  return {"libraries", list};
}

Fact machine() {
  const system::Machine machine = system::this_machine();
  return {"machine", fmt::format("{}, {}, {}, {} processors",
                                 machine.system.empty() ? "unknown system" : machine.system,
                                 machine.kernel, machine.architecture, machine.processors)};
}

Fact memory() {
  const system::Machine machine = system::this_machine();
  Fact fact{"memory",
            fmt::format("{}, {} free", size_words(static_cast<double>(machine.memory_bytes)),
                        size_words(static_cast<double>(machine.memory_free_bytes)))};
  constexpr std::uint64_t kCalibration = 256ULL << 20;
  const bool is_known = machine.memory_bytes > 0;
  if (is_known && machine.memory_free_bytes < kCalibration) {
    fact.problem = "less than 256 MiB are free, so a calibration may be killed; end other programs";
  }
  return fact;
}

Fact user() {
  const std::string name = system::user_name();
  return {"user", fmt::format("{} ({})", name.empty() ? "no name" : name, ::geteuid())};
}

Fact clock() {
  Fact fact{"clock", metering::to_string(std::chrono::floor<std::chrono::seconds>(
                         std::chrono::system_clock::now()))};
  if (system::is_clock_synchronised()) {
    fact.value += ", synchronised";
    return fact;
  }
  fact.value += ", not synchronised";
  fact.problem =
      "the kernel hears from no time server, so stamps may be wrong; set up chrony or "
      "systemd-timesyncd";
  return fact;
}

Fact time_zones() {
  Fact fact{"time zone data", system::time_zone_release()};
  if (fact.value == "unknown") {
    fact.problem = "the release of the time zone data is unknown; install the package tzdata";
  }
  return fact;
}

Fact energy_plus() {
  const auto found = energyplus::find_program({});
  return {"EnergyPlus",
          found ? fmt::format("{}, {}", found->version, found->executable.string()) : "not found"};
}

Fact serial_ports() {
  std::string list;
  for (const auto& port : system::serial_ports()) {
    list += fmt::format("{}{}{}", list.empty() ? "" : ", ", port.string(),
                        system::may_use(port) ? "" : " (may not be opened by this user)");
  }
  return {"serial ports", list.empty() ? "none" : list};
}

constexpr std::array kOfMachine{program, build, libraries,  machine,     memory,
                                user,    clock, time_zones, energy_plus, serial_ports};

}  // namespace

std::string size_words(double bytes) {
  constexpr double kMebibyte = 1024.0 * 1024.0;
  constexpr double kGibibyte = 1024.0 * kMebibyte;
  return bytes < kGibibyte ? fmt::format("{:.1f} MiB", bytes / kMebibyte)
                           : fmt::format("{:.1f} GiB", bytes / kGibibyte);
}

std::vector<Fact> machine_facts() {
  std::vector<Fact> facts;
  for (const auto& find_out : kOfMachine) facts.push_back(find_out());
  return facts;
}

}  // namespace recald::daemon
