/// The real program as it serves a site in a folder, for tests that ask it over the network.
#pragma once

#include <boost/asio/ip/tcp.hpp>
#include <filesystem>
#include <iterator>
#include <string>

#include "core/metering/civil_time.hpp"
#include "tests/support/background_process.hpp"
#include "tests/support/temporary_folder.hpp"

namespace recald::testing {

/// Runs the folder's site.toml, which listens on "127.0.0.1:0". One at a time.
class ServingDaemon {
 public:
  ServingDaemon(const std::string& program, const std::filesystem::path& folder)
      : said_{empty(folder / "said.txt")},
        process_{{program, "run", (folder / "site.toml").string()}, said_} {
    eventually([&] { return !port().empty(); });
  }

  /// Empty if it never listened.
  [[nodiscard]] std::string port() const {
    const std::string text = said();
    const std::size_t at = text.rfind(" port=");
    return at == std::string::npos ? "" : text.substr(at + 6, text.find('\n', at) - at - 6);
  }
  [[nodiscard]] std::string address() const { return "http://127.0.0.1:" + port(); }
  [[nodiscard]] std::string said() const {
    return std::filesystem::exists(said_) ? read_text(said_) : "";
  }

  /// @return the whole response.
  [[nodiscard]] std::string get(const std::string& path) const {
    return ask("GET " + path + " HTTP/1.1\r\nHost: localhost\r\nConnection: close\r\n\r\n");
  }
  [[nodiscard]] std::string post(const std::string& path, const std::string& json) const {
    return ask(
        "POST " + path +
        " HTTP/1.1\r\nHost: localhost\r\nConnection: close\r\nContent-Type: application/json\r\n"
        "Content-Length: " +
        std::to_string(json.size()) + "\r\n\r\n" + json);
  }

  void signal(int number) const { process_.signal(number); }
  /// @return the exit code, or minus the signal's number.
  int end(int signal) { return process_.end(signal); }

 private:
  /// Without what an earlier one said, whose port is another.
  static std::filesystem::path empty(const std::filesystem::path& file) {
    std::filesystem::remove(file);
    return file;
  }
  [[nodiscard]] std::string ask(const std::string& request) const {
    boost::asio::ip::tcp::iostream server{"127.0.0.1", port()};
    server << request << std::flush;
    return {std::istreambuf_iterator{server}, {}};
  }

  std::filesystem::path said_;
  BackgroundProcess process_;
};

/// Readings of the pushed meter "main", as POST /api/v1/readings takes them: a mean in kW for each
/// interval from `begin` on.
template <class MeanOf>
std::string readings_json(metering::Instant begin, std::chrono::seconds interval, int count,
                          MeanOf mean_kW) {
  std::string readings;
  for (int i = 0; i < count; ++i) {
    readings += readings.empty() ? "" : ",";
    readings += R"({"time":")" + metering::to_string(begin + i * interval) + R"(","value":)" +
                std::to_string(mean_kW(i)) + "}";
  }
  return R"({"meter":"main","unit":"kW","readings":[)" + readings + "]}";
}

}  // namespace recald::testing
