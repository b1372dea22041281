/// A real PostgreSQL 15 of Debian's beside a test, that can be stopped, killed with all of its
/// processes, and started again with what it kept.
#pragma once

#include <fcntl.h>
#include <signal.h>
#include <unistd.h>

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <memory>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "adapters/postgres/connection.hpp"
#include "tests/support/background_process.hpp"
#include "tests/support/loopback.hpp"
#include "tests/support/temporary_folder.hpp"

namespace recald::testing {

struct PostgresOptions {
  /// Needed only where a test kills the server and looks for what it had committed.
  bool is_durable = false;
  std::string password;  ///< That logins by TCP need; empty: none is asked for.
  std::string more;      ///< Lines of postgresql.conf.
};

/// On loopback, always on the same port, with the database "fleet" of the user "recald", who may do
/// all. Owned by the user "postgres" where the tests run as root, whom PostgreSQL refuses.
class PostgresServer {
 public:
  static bool can_run() { return std::filesystem::exists(kPrograms + "/initdb"); }

  /// Not started.
  explicit PostgresServer(const PostgresOptions& options = {}) : port_{free_port()} {
    write_text(log_, "");
    write_text(folder_ / "password", options.password);
    if (::geteuid() == 0) {
      shell("chown -R postgres: '" + folder_.path().string() + "'");
    }
    std::string make = as_user() + kPrograms + "/initdb -D '" + data_.string() +
                       "' -U recald -E UTF8 --locale=C.UTF-8 --no-sync -A ";
    make += options.password.empty() ? "trust"
                                     : "scram-sha-256 --auth-local=trust --pwfile='" +
                                           (folder_ / "password").string() + "'";
    shell(make);
    std::ofstream settings{data_ / "postgresql.conf", std::ios::app};
    settings << "listen_addresses = '127.0.0.1'\nport = " << port_
             << "\nunix_socket_directories = '" << folder_.path().string()
             << "'\nfsync = " << (options.is_durable ? "on" : "off")
             << "\nfull_page_writes = " << (options.is_durable ? "on" : "off")
             << "\nrecovery_init_sync_method = 'syncfs'\nshared_buffers = '32MB'\nmax_connections "
                "= 50\ntimezone = 'Asia/Kathmandu'\n"
             << options.more << '\n';
  }
  ~PostgresServer() {
    if (process_) kill();
  }
  PostgresServer(const PostgresServer&) = delete;
  PostgresServer& operator=(const PostgresServer&) = delete;

  /// Returns when it answers.
  void start() {
    std::vector<std::string> command{kPrograms + "/postgres", "-D", data_.string()};
    if (::geteuid() == 0) {
      command.insert(command.begin(), {"/usr/bin/setpriv", "--reuid=postgres", "--regid=postgres",
                                       "--clear-groups", "--"});
    }
    process_ = std::make_unique<BackgroundProcess>(command, log_);
    const bool answers = eventually([this] { return process_->has_ended() || is_ready(); });
    if (!answers || process_->has_ended()) {
      throw std::runtime_error("PostgreSQL does not answer: " + log());
    }
    if (!has_database_) shell(tool("createdb") + " fleet");
    has_database_ = true;
  }
  /// Ends connections, and itself in order.
  void stop() {
    process_->end(SIGINT);
    process_.reset();
  }
  /// As a disk that hangs: nothing answers, and the kernel still takes connections. Until thaw().
  void freeze() const { signal_all(SIGSTOP); }
  void thaw() const { signal_all(SIGCONT); }
  /// As a power cut would end all of its processes, but for what the operating system has.
  void kill() {
    process_->signal(SIGSTOP);  // or it would start others
    const std::vector<pid_t> others = children(process_->pid());
    process_->end(SIGKILL);
    for (const pid_t one : others) ::kill(one, SIGKILL);
    // They are nobody's now, and it does not start again beside one of them.
    eventually([&] {
      bool is_gone = true;
      for (const pid_t one : others) is_gone = is_gone && state_of(one).first == '?';
      return is_gone;
    });
    process_.reset();
  }

  [[nodiscard]] std::uint16_t port() const { return port_; }
  [[nodiscard]] std::string url(const std::string& database = "fleet") const {
    return url_of(port_, database);
  }
  /// Of somebody between the test and the server.
  [[nodiscard]] static std::string url_of(std::uint16_t port,
                                          const std::string& database = "fleet") {
    return "postgresql://recald@127.0.0.1:" + std::to_string(port) + "/" + database;
  }
  /// What it says, over restarts.
  [[nodiscard]] std::string log() const { return read_text(log_); }

  /// A database of its own, for a test. @return its address
  [[nodiscard]] std::string new_database() {
    const std::string name = "test" + std::to_string(databases_++);
    shell(tool("createdb") + " " + name);
    return url(name);
  }
  /// What psql prints for statements: an independent reader.
  [[nodiscard]] std::string ask(const std::string& statements,
                                const std::string& database = "fleet") const {
    write_text(folder_ / "asked.sql", statements);
    return run_in_shell(tool("psql") + " -X -q -A -t -d " + database + " -f '" +
                        (folder_ / "asked.sql").string() + "' 2>&1")
        .said;
  }

 private:
  inline static const std::string kPrograms = "/usr/lib/postgresql/15/bin";

  void signal_all(int signal) const {
    process_->signal(signal);  // first: it starts others
    for (const pid_t one : children(process_->pid())) ::kill(one, signal);
  }
  static void shell(const std::string& command) {
    const auto end = run_in_shell(command + " 2>&1");
    if (end.status != 0) throw std::runtime_error(command + ": " + end.said);
  }
  static std::string as_user() {
    return ::geteuid() == 0 ? "setpriv --reuid=postgres --regid=postgres --clear-groups -- " : "";
  }
  [[nodiscard]] std::string tool(const std::string& name) const {
    return kPrograms + "/" + name + " -h '" + folder_.path().string() + "' -p " +
           std::to_string(port_) + " -U recald";
  }
  [[nodiscard]] bool is_ready() const {
    return run_in_shell(tool("psql") + " -X -q -d postgres -c 'SELECT 1' >/dev/null 2>&1").status ==
           0;
  }

  /// State and parent of a process; '?' for one that is not there.
  static std::pair<char, pid_t> state_of(pid_t process) {
    std::ifstream in{"/proc/" + std::to_string(process) + "/stat"};
    const std::string text{std::istreambuf_iterator<char>{in}, {}};
    const std::size_t at = text.rfind(") ");
    if (at == std::string::npos || text[at + 2] == 'Z') return {'?', 0};
    return {text[at + 2], std::stoi(text.substr(at + 4))};
  }
  static std::vector<pid_t> children(pid_t parent) {
    std::vector<pid_t> found;
    for (const auto& entry : std::filesystem::directory_iterator{"/proc"}) {
      const std::string name = entry.path().filename();
      if (name.find_first_not_of("0123456789") != std::string::npos) continue;
      if (state_of(std::stoi(name)).second == parent) found.push_back(std::stoi(name));
    }
    return found;
  }

  TemporaryFolder folder_;
  std::uint16_t port_;
  const std::filesystem::path data_ = folder_ / "data";
  const std::filesystem::path log_ = folder_ / "log";
  bool has_database_ = false;
  int databases_ = 0;
  std::unique_ptr<BackgroundProcess> process_;
};

}  // namespace recald::testing
