#include "adapters/mqtt/connection.hpp"

namespace recald::mqtt {

class Connection::Client {};

Connection::Connection(std::unique_ptr<Client> client) : client_{std::move(client)} {}
Connection::~Connection() = default;

Result<std::unique_ptr<Connection>> Connection::open(Broker, Session, OnMessage, OnState) {
  return failure(ErrorCode::unsupported, "there is no MQTT yet");
}
Result<void> Connection::publish(std::span<const Message>, std::chrono::milliseconds,
                                 const std::stop_token&) {
  return failure(ErrorCode::unsupported, "there is no MQTT yet");
}
bool Connection::is_connected() const { return false; }

}  // namespace recald::mqtt
