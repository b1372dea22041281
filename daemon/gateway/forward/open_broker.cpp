#include "daemon/gateway/forward/open_broker.hpp"

#include <fmt/format.h>

#include <utility>

#include "adapters/http/credentials.hpp"

namespace recald::daemon {
namespace {

Result<mqtt::Broker> broker_of(const BrokerConfig& config) {
  mqtt::Broker broker{.host = config.host,
                      .port = config.port,
                      .is_tls = config.is_tls,
                      .client_id = config.client_id,
                      .user = config.login.user,
                      .password = {},
                      .trusted_certificate = config.trusted_certificate,
                      .certificate_file = config.certificate_file,
                      .key_file = config.key_file};
  if (config.login.user.empty()) return broker;
  broker.password = TRY(http::read_password_file(config.login.password_file));
  return broker;
}

}  // namespace

Result<std::unique_ptr<mqtt::Connection>> open_broker(const BrokerConfig& config,
                                                      mqtt::Session session,
                                                      mqtt::Connection::OnMessage on_message,
                                                      mqtt::Connection::OnState on_state) {
  auto broker = TRY(broker_of(config));
  return mqtt::Connection::open(std::move(broker), std::move(session), std::move(on_message),
                                std::move(on_state));
}

std::optional<StoreEvent> BrokerNews::on_state(const std::string& words, bool is_connected,
                                               const std::string& why) {
  StoreEvent event;
  event.severity = Severity::warning;
  event.subject = words;
  event.is_counted = true;
  if (!is_connected) {
    // Of an attempt each minute, once.
    if (std::exchange(is_lost_, true) && why == lost_why_) return {};
    lost_why_ = why;
    event.kind = "broker_lost";
    event.text = fmt::format("the {} is not connected: {}; recald keeps trying", words, why);
  } else if (!why.empty()) {  // connected, and something was refused or dropped
    event.kind = "broker_refuses";
    event.text = why;
  } else {
    if (!std::exchange(is_lost_, false)) return {};
    event.severity = Severity::info;
    event.kind = "broker_found";
    event.text = fmt::format("the {} is connected again", words);
  }
  return event;
}

}  // namespace recald::daemon
