#include "daemon/gateway/alert/deliver.hpp"

#include "adapters/delivery/delivery.hpp"
#include "adapters/http/credentials.hpp"

namespace recald::daemon {
namespace {

Result<void> post(const WebhookConfig& config, const AlertMessage& message,
                  const std::stop_token& stop) {
  delivery::Webhook webhook{
      .url = config.url, .token = {}, .trusted_certificate = config.trusted_certificate};
  if (!config.token_file.empty()) {
    webhook.token = TRY(http::read_token_file(config.token_file));
  }
  return delivery::post_json(webhook, message.document, stop);
}

Result<void> mail(const MailConfig& config, const AlertMessage& message,
                  const std::stop_token& stop) {
  delivery::MailServer server{.url = config.server,
                              .user = config.user,
                              .password = {},
                              .encrypts = config.encrypts,
                              .trusted_certificate = config.trusted_certificate};
  if (!config.password_file.empty()) {
    server.password = TRY(http::read_password_file(config.password_file));
  }
  return delivery::send_mail(server,
                             {.from = config.from,
                              .to = config.to,
                              .subject = message.subject,
                              .text = message.text,
                              .id = message.id,
                              .date = message.time},
                             stop);
}

}  // namespace

Result<void> deliver(const AlertDestination& destination, const AlertMessage& message,
                     const std::stop_token& stop) {
  if (const auto* const webhook = std::get_if<WebhookConfig>(&destination)) {
    return post(*webhook, message, stop);
  }
  return mail(std::get<MailConfig>(destination), message, stop);
}

}  // namespace recald::daemon
