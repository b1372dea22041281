/// Sends a message to a web address or a mail server.
///
/// Wraps libcurl. All calls block, for at most half a minute, and end soon after a stop is
/// requested.
#pragma once

#include <chrono>
#include <filesystem>
#include <stop_token>
#include <string>
#include <vector>

#include "adapters/delivery/mail_text.hpp"
#include "core/result.hpp"

namespace recald::delivery {

struct Webhook {
  std::string url;    ///< http or https.
  std::string token;  ///< Sent as a Bearer token; empty: none.
  /// PEM; trusted instead of what the system trusts. Empty: as the system.
  std::filesystem::path trusted_certificate;
};

struct MailServer {
  std::string url;   ///< "smtps://mail.example.org", "smtp://mail.example.org:587".
  std::string user;  ///< Empty: the server asks for none.
  std::string password;
  bool encrypts = true;  ///< smtp:// goes on after STARTTLS, or fails; otherwise all stays plain.
  std::filesystem::path trusted_certificate;  ///< As in Webhook.
};

/// What is sent to a web address.
struct Post {
  std::string url;                            ///< http or https.
  std::string token;                          ///< Sent as a Bearer token; empty: none.
  std::string user;                           ///< Sent with the password (Basic); empty: none.
  std::string password;                       ///< Of the user.
  std::filesystem::path trusted_certificate;  ///< As in Webhook.
  std::string content_type;
  std::vector<std::string> headers;  ///< Further ones: "Content-Encoding: snappy".
  std::string body;                  ///< Any bytes.
};

/// What a server said, whatever it was.
struct Answer {
  long status;
  std::string body;                     ///< Its first 500 bytes.
  std::chrono::seconds retry_after{0};  ///< As the server asks (Retry-After); 0: it does not.
};

/// Posts any body; does not follow redirections.
/// @return or io_failed: no server, no trust, the connection broke or took too long; cancelled.
[[nodiscard]] Result<Answer> post(const Post& post, const std::stop_token& stop);

/// Posts a JSON document; does not follow redirections.
/// @return or io_failed: no server, no trust, a status other than 2xx; out_of_range: a status that
/// refuses what is in the message; cancelled.
[[nodiscard]] Result<void> post_json(const Webhook& webhook, const std::string& document,
                                     const std::stop_token& stop);

/// @return or io_failed: no server, no trust, or the server accepted the mail for nobody;
/// out_of_range: it refuses what is in the mail; cancelled.
[[nodiscard]] Result<void> send_mail(const MailServer& server, const Mail& mail,
                                     const std::stop_token& stop);

/// The host of an address, for messages: the rest of a web address is often a secret. "the server"
/// for what is no address.
[[nodiscard]] std::string host_of(const std::string& url);

}  // namespace recald::delivery
