/// A real mail server and a web server beside a test (message_sink.py), and what they were sent.
#pragma once

#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "tests/support/background_process.hpp"
#include "tests/support/temporary_folder.hpp"

namespace recald::testing {

class MessageSink {
 public:
  static bool can_run() {
    return std::filesystem::exists("/usr/lib/python3/dist-packages/aiosmtpd");
  }

  /// @param script  tests/support/message_sink.py. @param more  Options.
  explicit MessageSink(const std::string& script, const std::vector<std::string>& more = {}) {
    const auto said = folder_ / "said.txt";
    write_text(said, "");
    std::vector<std::string> command{"/usr/bin/python3", script, folder_.path().string()};
    command.insert(command.end(), more.begin(), more.end());
    process_ = std::make_unique<BackgroundProcess>(command, said);
    if (!eventually([&] { return read_text(said).ends_with('\n'); })) {
      throw std::runtime_error("the sink does not listen: " + read_text(said));
    }
    std::istringstream words{read_text(said)};
    std::string ignored;
    words >> ignored >> mail_port_ >> ignored >> web_port_;
  }

  [[nodiscard]] std::string mail_url(const std::string& host = "127.0.0.1") const {
    return "smtp://" + host + ":" + mail_port_;
  }
  [[nodiscard]] std::string web_url(const std::string& path) const {
    return "http://127.0.0.1:" + web_port_ + path;
  }

  /// In order of arrival.
  [[nodiscard]] std::vector<nlohmann::json> messages() const {
    std::set<std::filesystem::path> files;
    for (const auto& entry : std::filesystem::directory_iterator{folder_.path()}) {
      if (entry.path().extension() == ".json") files.insert(entry.path());
    }
    std::vector<nlohmann::json> found;
    for (const auto& file : files) found.push_back(nlohmann::json::parse(read_text(file)));
    return found;
  }

 private:
  TemporaryFolder folder_;
  std::unique_ptr<BackgroundProcess> process_;
  std::string mail_port_;
  std::string web_port_;
};

}  // namespace recald::testing
