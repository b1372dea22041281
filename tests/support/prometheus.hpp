/// A real Prometheus beside a test, that takes remote writes.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "tests/support/local_server.hpp"

namespace recald::testing {

struct PrometheusOptions {
  bool receives = true;             ///< --web.enable-remote-write-receiver
  std::string out_of_order_window;  ///< "30d"; empty: as Prometheus comes.
};

class Prometheus {
 public:
  static bool can_run() { return std::filesystem::exists("/usr/bin/prometheus"); }

  /// Not started.
  explicit Prometheus(PrometheusOptions options = {}) : receives_{options.receives} {
    std::string text = "global:\n  scrape_interval: 1h\n";
    if (!options.out_of_order_window.empty()) {
      text +=
          "storage:\n  tsdb:\n    out_of_order_time_window: " + options.out_of_order_window + "\n";
    }
    write_text(server_.folder() / "prometheus.yml", text);
  }

  /// The first time, or after kill().
  void start() {
    std::vector<std::string> command{
        "/usr/bin/prometheus", "--config.file=" + (server_.folder() / "prometheus.yml").string(),
        "--storage.tsdb.path=" + (server_.folder() / "data").string(),
        "--storage.tsdb.retention.time=10y", "--web.listen-address=127.0.0.1:" + server_.port()};
    if (receives_) command.emplace_back("--web.enable-remote-write-receiver");
    server_.start(command, "msg=\"Listening on\" address=127.0.0.1:");
    if (!eventually([&] { return server_.ask("/-/ready").find("Ready") != std::string::npos; })) {
      throw std::runtime_error("Prometheus is not ready: " +
                               read_text(server_.folder() / "said.txt"));
    }
  }
  void kill() { server_.kill(); }

  [[nodiscard]] const std::string& port() const { return server_.port(); }
  [[nodiscard]] std::string write_url() const { return server_.url("/api/v1/write"); }

  /// @return `data.result`. Of a range selector, `recald_interval_mean_kilowatts[30d]`, that is
  /// each
  ///         series as {"metric": {label: value}, "values": [[seconds, "number"], …]}.
  [[nodiscard]] nlohmann::json query(const std::string& expression) const {
    const std::string answer = server_.ask("/api/v1/query", {{"query", expression}});
    const auto json = nlohmann::json::parse(answer, nullptr, false);
    if (!json.is_object() || json.value("status", "") != "success") {
      throw std::runtime_error(expression + ": " + answer);
    }
    return json["data"]["result"];
  }

 private:
  LocalServer server_;
  bool receives_;
};

}  // namespace recald::testing
