/// A mail as the bytes that are sent: RFC 5322 with MIME headers.
#pragma once

#include <string>
#include <vector>

#include "core/metering/civil_time.hpp"

namespace recald::delivery {

struct Mail {
  std::string from;             ///< "recald@example.org"
  std::vector<std::string> to;  ///< Addresses.
  std::string subject;          ///< UTF-8.
  std::string text;             ///< UTF-8, lines end with "\n".
  std::string id;               ///< The same for a mail that is sent again: "depot-17".
  metering::Instant date;
};

/// Headers and body, lines end with CRLF. Text outside ASCII is encoded (RFC 2047 in the subject,
/// base64 in the body), so any server passes it on, and no line of a text can become a header.
[[nodiscard]] std::string mail_text(const Mail& mail);

}  // namespace recald::delivery
