/// A real InfluxDB 1.6 beside a test.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "tests/support/local_server.hpp"

namespace recald::testing {

struct InfluxDbOptions {
  bool asks_for_password = false;  ///< Then it has one user, who may do all: "ada", "a password".
};

class InfluxDb {
 public:
  static bool can_run() { return std::filesystem::exists("/usr/bin/influxd"); }

  /// Not started.
  explicit InfluxDb(InfluxDbOptions options = {}) : asks_{options.asks_for_password} {}

  /// The first time, or after kill().
  void start() {
    const std::string folder = server_.folder().path().string();
    write_text(folder + "/influxdb.conf",
               "reporting-disabled = true\nbind-address = \"127.0.0.1:0\"\n[meta]\ndir = \"" +
                   folder + "/meta\"\n[data]\ndir = \"" + folder + "/data\"\nwal-dir = \"" +
                   folder + "/wal\"\n[monitor]\nstore-enabled = false\n[http]\nauth-enabled = " +
                   (asks_ ? "true" : "false") + "\nbind-address = \"127.0.0.1:" + server_.port() +
                   "\"\n");
    const bool is_new = server_.port() == "0";
    server_.start({"/usr/bin/influxd", "run", "-config", folder + "/influxdb.conf"},
                  "addr=127.0.0.1:");
    if (is_new && asks_) {
      query("CREATE USER ada WITH PASSWORD 'a password' WITH ALL PRIVILEGES");
    }
  }
  void kill() { server_.kill(); }

  [[nodiscard]] const std::string& port() const { return server_.port(); }
  [[nodiscard]] std::string write_url(const std::string& database) const {
    return server_.url("/write?db=" + database);
  }

  /// @return the statement's `series`, each {"name", "tags", "columns", "values"} with times in
  ///         seconds; an empty list where there is none.
  nlohmann::json query(const std::string& statement, const std::string& database = "") const {
    const std::string path = asks_ ? "/query?u=ada&p=a%20password" : "/query";
    const std::string answer =
        server_.ask(path, {{"q", statement}, {"db", database}, {"epoch", "s"}});
    const auto json = nlohmann::json::parse(answer, nullptr, false);
    if (!json.is_object() || !json.contains("results") || json["results"][0].contains("error")) {
      throw std::runtime_error(statement + ": " + answer);
    }
    return json["results"][0].value("series", nlohmann::json::array());
  }

 private:
  LocalServer server_;
  bool asks_;
};

}  // namespace recald::testing
