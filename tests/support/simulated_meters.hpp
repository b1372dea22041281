/// `recald-sim meters` beside a test: what it listens on is known when the constructor returns.
#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "tests/support/background_process.hpp"
#include "tests/support/temporary_folder.hpp"

namespace recald::testing {

class SimulatedMeters {
 public:
  /// @param program  recald-sim.
  /// @param plan     TOML; port 0 lets the system choose. Written into a folder of its own.
  /// @param files    Further files in that folder: fault scripts, recordings.
  /// @param options  "--clock" and its value, "--faults" and one of the files.
  SimulatedMeters(const std::string& program, const std::string& plan,
                  const std::map<std::string, std::string>& files = {},
                  const std::vector<std::string>& options = {}) {
    for (const auto& [name, text] : files) write_text(folder_ / name, text);
    write_text(folder_ / "plan.toml", plan);
    write_text(said(), "");
    std::vector<std::string> command{program, "meters", (folder_ / "plan.toml").string()};
    for (const std::string& option : options) {
      command.push_back(files.contains(option) ? (folder_ / option).string() : option);
    }
    process_ = std::make_unique<BackgroundProcess>(command, said());
    if (!eventually([&] { return what_was_said().find("ready: ") != std::string::npos; })) {
      throw std::runtime_error("simulated devices are not ready: " + what_was_said());
    }
    std::istringstream lines{what_was_said()};
    const std::string begin = "listening on ";
    for (std::string line; std::getline(lines, line);) {
      if (!line.starts_with(begin)) continue;
      addresses_.push_back(line.substr(begin.size(), line.rfind(": ") - begin.size()));
    }
  }

  /// "127.0.0.1:40123", or the link of a pseudo-terminal; in order of the plan.
  [[nodiscard]] const std::string& address(std::size_t endpoint) const {
    return addresses_.at(endpoint);
  }
  [[nodiscard]] std::uint16_t port(std::size_t endpoint) const {
    const std::string& all = address(endpoint);
    return static_cast<std::uint16_t>(std::stoi(all.substr(all.rfind(':') + 1)));
  }
  [[nodiscard]] std::string what_was_said() const { return read_text(said()); }

  /// Ends it as a user would. @return the exit code.
  int end() { return process_->end(SIGTERM); }

 private:
  [[nodiscard]] std::filesystem::path said() const { return folder_ / "said.txt"; }

  TemporaryFolder folder_;
  std::unique_ptr<BackgroundProcess> process_;
  std::vector<std::string> addresses_;
};

}  // namespace recald::testing
