/// A web server of Debian's beside a test, that can be killed and started again with what it kept.
#pragma once

#include <csignal>
#include <filesystem>
#include <memory>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "tests/support/background_process.hpp"
#include "tests/support/temporary_folder.hpp"

namespace recald::testing {

class LocalServer {
 public:
  /// Its files, and what it says: said.txt.
  [[nodiscard]] const TemporaryFolder& folder() const { return folder_; }
  /// "0" before the first start, then the one that the server found free, which it keeps.
  [[nodiscard]] const std::string& port() const { return port_; }
  [[nodiscard]] std::string url(const std::string& path) const {
    return "http://127.0.0.1:" + port_ + path;
  }

  /// @param before_port  What stands in its log before the port that it listens on.
  void start(const std::vector<std::string>& command, const std::string& before_port) {
    const auto said = folder_ / "said.txt";
    write_text(said, "");
    process_ = std::make_unique<BackgroundProcess>(command, said);
    const bool listens = eventually([&] {
      const std::string text = read_text(said);
      const std::size_t at = text.find(before_port);
      const std::size_t end = text.find_first_not_of("0123456789", at + before_port.size());
      if (at == std::string::npos || end == std::string::npos) return process_->has_ended();
      port_ = text.substr(at + before_port.size(), end - at - before_port.size());
      return true;
    });
    if (!listens || process_->has_ended()) {
      throw std::runtime_error(command[0] + " does not listen: " + read_text(said));
    }
  }
  void kill() { process_.reset(); }

  /// Posts a form, by curl. @return what comes back; empty where there is no server.
  [[nodiscard]] std::string ask(
      const std::string& path,
      const std::vector<std::pair<std::string, std::string>>& form = {}) const {
    std::string command = "curl -s '" + url(path) + "'";
    for (const auto& [name, value] : form) {
      write_text(folder_ / ("form-" + name), value);
      command += " --data-urlencode " + name + "@" + (folder_ / ("form-" + name)).string();
    }
    return run_in_shell(command).said;
  }

 private:
  TemporaryFolder folder_;
  std::unique_ptr<BackgroundProcess> process_;
  std::string port_ = "0";
};

}  // namespace recald::testing
