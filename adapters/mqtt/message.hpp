/// A message of MQTT, what a broker is, and what a session does by itself.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace recald::mqtt {

struct Broker {
  std::string host;
  std::uint16_t port = 1883;
  bool is_tls = false;
  std::string client_id;  ///< Of a persistent session: the same again finds what was kept for it.
  std::string user;       ///< Empty: the broker asks for none.
  std::string password;
  /// PEM; trusted instead of what the system trusts. Empty: as the system.
  std::filesystem::path trusted_certificate;
  std::filesystem::path certificate_file;  ///< PEM, of the client; empty: none.
  std::filesystem::path key_file;          ///< PEM, of the client; empty: none.
};

struct Message {
  std::string topic;
  std::string payload;
  /// Outgoing: the broker is to keep it for later subscribers. Incoming: it had been kept, so it
  /// may be old.
  bool is_retained = false;

  bool operator==(const Message&) const = default;
};

/// What it takes in memory: an empty one too, for queues with a limit.
[[nodiscard]] inline std::size_t bytes_of(const Message& message) {
  return sizeof(Message) + message.topic.size() + message.payload.size();
}

/// What the connection does by itself whenever it is made again.
struct Session {
  std::optional<Message> will;      ///< Sent by the broker if the connection breaks.
  std::optional<Message> birth;     ///< Published after each connect.
  std::vector<std::string> topics;  ///< Topic filters, subscribed with QoS 1.
  /// The broker keeps for a day what is sent to us while we are away; otherwise nothing.
  bool is_kept = true;
};

}  // namespace recald::mqtt
