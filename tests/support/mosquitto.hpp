/// A real broker (Debian's mosquitto) beside a test, and its own programs as independent reader and
/// sender.
#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <sstream>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "adapters/mqtt/message.hpp"
#include "tests/support/background_process.hpp"
#include "tests/support/loopback.hpp"
#include "tests/support/temporary_folder.hpp"

namespace recald::testing {

/// How many times `words` stand in `text`.
inline std::size_t count_of(std::string_view words, std::string_view text) {
  std::size_t count = 0;
  for (std::size_t at = 0; (at = text.find(words, at)) != std::string_view::npos; ++at) ++count;
  return count;
}

/// A reader that stays connected (mosquitto_sub, QoS 1), and connects again by itself.
class MosquittoReader {
 public:
  MosquittoReader(const std::vector<std::string>& command, std::filesystem::path file)
      : file_{std::move(file)}, process_{command, file_} {}

  /// In order of arrival; whole lines alone.
  [[nodiscard]] std::vector<mqtt::Message> messages() const {
    std::vector<mqtt::Message> found;
    const std::string text = read_text(file_);
    std::size_t begin = 0;
    for (std::size_t end; (end = text.find('\n', begin)) != std::string::npos; begin = end + 1) {
      if (text[begin] != '{') continue;
      const auto line = nlohmann::json::parse(text.substr(begin, end - begin));
      const auto& payload = line.at("payload");  // null: empty
      found.push_back({.topic = line.at("topic"),
                       .payload = payload.is_null() ? "" : payload.get<std::string>(),
                       .is_retained = line.at("retain") == 1});
    }
    return found;
  }
  [[nodiscard]] std::size_t count() const { return count_of("\n", read_text(file_)); }
  int wait() { return process_.wait(); }

 private:
  std::filesystem::path file_;
  BackgroundProcess process_;
};

struct MosquittoOptions {
  bool is_persistent = false;  ///< Sessions and retained messages outlive stop(), not kill().
  std::filesystem::path certificate, key;    ///< PEM; TLS if there is one.
  std::filesystem::path client_certificate;  ///< PEM that clients must show, or be signed by.
  std::string acl;                           ///< Lines of an acl_file; empty: all is allowed.
  std::string more;                          ///< Lines of mosquitto.conf.
};

class Mosquitto {
 public:
  static bool can_run() {
    return std::filesystem::exists(kBroker) && std::filesystem::exists("/usr/bin/mosquitto_sub");
  }

  /// Not started. Everybody may log in until set_password().
  explicit Mosquitto(MosquittoOptions options = {})
      : options_{std::move(options)}, port_{free_port()} {
    write_text(log_, "");
  }

  /// Returns when it listens. Always on the same port.
  void start() {
    write_configuration();
    process_ = std::make_unique<BackgroundProcess>(
        std::vector<std::string>{kBroker, "-c", configuration_.string()}, log_);
    if (!eventually([this] { return process_->has_ended() || listens(); }) ||
        process_->has_ended()) {
      throw std::runtime_error("mosquitto does not listen: " + log());
    }
  }
  void stop() { end(SIGTERM); }
  void kill() { end(SIGKILL); }
  /// The process lives and does nothing any more, or goes on.
  void freeze() const { process_->signal(SIGSTOP); }
  void thaw() const { process_->signal(SIGCONT); }
  /// Reads passwords and access rights again.
  void reload() const { process_->signal(SIGHUP); }

  [[nodiscard]] std::uint16_t port() const { return port_; }
  /// What it says (log_type all) since it was made, over restarts.
  [[nodiscard]] std::string log() const { return read_text(log_); }

  /// From the next start or reload on, only those with a password are let in. The last one set is
  /// what read(), reader() and send() log in with.
  void set_password(const std::string& user, const std::string& password) {
    if (!std::filesystem::exists(passwords_)) write_text(passwords_, "");
    const auto end = run_in_shell("/usr/bin/mosquitto_passwd -b " + passwords_.string() + " " +
                                  user + " " + password);
    if (end.status != 0) throw std::runtime_error("no password: " + end.said);
    login_ = {"-u", user, "-P", password};
  }

  /// What comes on the topics, retained messages too, until there are `count` or time is over.
  [[nodiscard]] std::vector<mqtt::Message> read(const std::string& filter, std::size_t count,
                                                std::chrono::seconds time_max) {
    auto command = program("mosquitto_sub", filter);
    for (const std::string& word : {std::string{"-C"}, std::to_string(count), std::string{"-W"},
                                    std::to_string(time_max.count()), std::string{"-q"},
                                    std::string{"1"}, std::string{"-F"}, std::string{"%j"}}) {
      command.push_back(word);
    }
    MosquittoReader reader{command, new_file()};
    reader.wait();
    return reader.messages();
  }

  /// Returns when it has subscribed.
  [[nodiscard]] std::unique_ptr<MosquittoReader> reader(const std::string& filter) {
    auto command = program("mosquitto_sub", filter);
    const std::string id = "reader" + std::to_string(files_);
    for (const char* word : {"-q", "1", "-F", "%j", "-i", id.c_str()}) command.emplace_back(word);
    auto made = std::make_unique<MosquittoReader>(command, new_file());
    if (!eventually([&] { return subscriptions(id) > 0; })) {
      throw std::runtime_error("no subscription: " + log());
    }
    return made;
  }
  /// How often a client has subscribed.
  [[nodiscard]] std::size_t subscriptions(const std::string& client_id) const {
    return count_of("Sending SUBACK to " + client_id + "\n", log());
  }

  /// Publishes with QoS 1 (mosquitto_pub); returns when it is acknowledged.
  void send(const mqtt::Message& message) {
    auto command = program("mosquitto_pub", message.topic);
    const auto payload = new_file();
    write_text(payload, message.payload);
    for (const std::string& word :
         {std::string{"-q"}, std::string{"1"}, std::string{"-f"}, payload.string()}) {
      command.push_back(word);
    }
    if (message.payload.empty()) {
      command.resize(command.size() - 2);
      command.emplace_back("-n");
    }
    if (message.is_retained) command.emplace_back("-r");
    const auto said = new_file();
    if (BackgroundProcess{command, said}.wait() != 0) {
      throw std::runtime_error("mosquitto_pub: " + read_text(said));
    }
  }

 private:
  static constexpr const char* kBroker = "/usr/sbin/mosquitto";

  [[nodiscard]] bool listens() const {
    const int socket = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
    const ::sockaddr_in address = loopback(port_);
    const bool is_open =
        ::connect(socket, reinterpret_cast<const ::sockaddr*>(&address), sizeof address) == 0;
    ::close(socket);
    return is_open;
  }

  void end(int signal) {
    process_->end(signal);
    process_.reset();
  }

  void write_configuration() const {
    std::ostringstream out;
    // As root it would become another user, who may not read the folder.
    out << "user root\nlistener " << port_ << " 127.0.0.1\nlog_dest stderr\nlog_type all\n";
    out << "persistence " << (options_.is_persistent ? "true" : "false")
        << "\npersistence_location " << folder_.path().string() << "/\n";
    const bool has_passwords = std::filesystem::exists(passwords_);
    out << "allow_anonymous " << (has_passwords ? "false" : "true") << '\n';
    if (has_passwords) out << "password_file " << passwords_.string() << '\n';
    if (!options_.acl.empty()) {
      write_text(folder_ / "acl", options_.acl);
      out << "acl_file " << (folder_ / "acl").string() << '\n';
    }
    if (!options_.certificate.empty()) {
      out << "certfile " << options_.certificate.string() << "\nkeyfile " << options_.key.string()
          << '\n';
    }
    if (!options_.client_certificate.empty()) {
      out << "require_certificate true\ncafile " << options_.client_certificate.string() << '\n';
    }
    out << options_.more << '\n';
    write_text(configuration_, out.str());
  }

  [[nodiscard]] std::vector<std::string> program(const std::string& name,
                                                 const std::string& topic) const {
    std::vector<std::string> command{"/usr/bin/" + name,    "-V", "5",  "-h", "localhost", "-p",
                                     std::to_string(port_), "-t", topic};
    if (!options_.certificate.empty()) {
      command.insert(command.end(), {"--cafile", options_.certificate.string()});
    }
    command.insert(command.end(), login_.begin(), login_.end());
    return command;
  }
  std::filesystem::path new_file() {
    auto file = folder_ / ("file" + std::to_string(files_++));
    write_text(file, "");
    return file;
  }

  TemporaryFolder folder_;
  MosquittoOptions options_;
  std::uint16_t port_;
  const std::filesystem::path log_ = folder_ / "log";
  const std::filesystem::path configuration_ = folder_ / "mosquitto.conf";
  const std::filesystem::path passwords_ = folder_ / "passwords";
  std::vector<std::string> login_;
  int files_ = 0;
  std::unique_ptr<BackgroundProcess> process_;
};

}  // namespace recald::testing
