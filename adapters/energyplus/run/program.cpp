#include "adapters/energyplus/run/program.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <cstdlib>
#include <fstream>
#include <iterator>
#include <optional>
#include <regex>
#include <string_view>

#include "adapters/system/child_process.hpp"
#include "adapters/system/files/scratch_folder.hpp"

namespace recald::energyplus {
namespace {

constexpr std::string_view kName = "energyplus";
constexpr int kOldestMajor = 9;  // the first whose SQLite output has the tables that are read

bool is_program(const std::filesystem::path& file) {
  std::error_code ignored;
  return std::filesystem::is_regular_file(file, ignored) && ::access(file.c_str(), X_OK) == 0;
}

/// The program itself, or in the folder that was named instead.
std::optional<std::filesystem::path> program_at(const std::filesystem::path& place) {
  for (const auto& file : {place, place / kName}) {
    if (is_program(file)) return std::filesystem::absolute(file);
  }
  return {};
}

std::optional<std::filesystem::path> program_on_path() {
  const char* const path = std::getenv("PATH");
  std::string_view rest = path == nullptr ? "" : path;
  while (!rest.empty()) {
    const std::size_t end = std::min(rest.find(':'), rest.size());
    const std::filesystem::path folder{rest.substr(0, end)};
    rest.remove_prefix(std::min(end + 1, rest.size()));
    if (!folder.empty() && is_program(folder / kName)) {
      return std::filesystem::absolute(folder / kName);
    }
  }
  return {};
}

Result<std::filesystem::path> locate(const std::filesystem::path& configured) {
  const char* const environment = std::getenv("RECALD_ENERGYPLUS");
  const bool has_environment = environment != nullptr && *environment != '\0';
  for (const auto& [place, what] :
       {std::pair{configured, "'program' of the site file"},
        std::pair{std::filesystem::path{has_environment ? environment : ""},
                  "RECALD_ENERGYPLUS"}}) {
    if (place.empty()) continue;
    if (auto found = program_at(place)) return std::move(*found);
    return failure(ErrorCode::not_found,
                   fmt::format("there is no EnergyPlus at {}, which is what {} "
                               "says",
                               place.string(), what));
  }
  if (auto found = program_on_path()) return std::move(*found);
  return failure(ErrorCode::not_found,
                 "EnergyPlus was not found; install it from energyplus.net, then put its folder on "
                 "PATH or name it in RECALD_ENERGYPLUS");
}

}  // namespace

Result<Program> find_program(const std::filesystem::path& configured) {
  const auto executable = TRY(locate(configured));
  const auto scratch = TRY(system::ScratchFolder::make());
  const std::filesystem::path output = scratch.path() / "version.txt";
  TRY(system::run_child({.program = executable,
                         .arguments = {"--version"},
                         .folder = scratch.path(),
                         .output = output,
                         .time_max = std::chrono::seconds{60}},
                        {}));
  std::ifstream in{output};
  const std::string text{std::istreambuf_iterator<char>{in}, {}};
  std::smatch match;
  if (!std::regex_search(text, match, std::regex{R"(Version (\d+)\.(\d+))"})) {
    return failure(ErrorCode::io_failed,
                   fmt::format("{} does not say its version, as EnergyPlus does; it said '{}'",
                               executable.string(), text.substr(0, 200)));
  }
  if (std::stoi(match[1]) < kOldestMajor) {
    return failure(ErrorCode::unsupported,
                   fmt::format("{} is EnergyPlus {}.{}; recald needs {}.0 or later",
                               executable.string(), match[1].str(), match[2].str(), kOldestMajor));
  }
  return Program{executable, fmt::format("{}.{}", match[1].str(), match[2].str())};
}

}  // namespace recald::energyplus
