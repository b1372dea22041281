#include "adapters/delivery/mail_text.hpp"

#include <fmt/chrono.h>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <openssl/evp.h>

#include <algorithm>
#include <string_view>

#include "core/text/printable.hpp"

namespace recald::delivery {
namespace {

constexpr std::size_t kEncodedLineBytes = 57;  // 76 characters of base64
constexpr std::size_t kEncodedWordBytes = 39;  // an encoded word has at most 75 characters

std::string base64(std::string_view bytes) {
  std::string text(4 * ((bytes.size() + 2) / 3) + 1, '\0');  // it writes a zero after the text
  const int size = EVP_EncodeBlock(reinterpret_cast<unsigned char*>(text.data()),
                                   reinterpret_cast<const unsigned char*>(bytes.data()),
                                   static_cast<int>(bytes.size()));
  text.resize(static_cast<std::size_t>(size));
  return text;
}

bool is_printable_ascii(std::string_view text) {
  return std::ranges::all_of(text, [](char c) { return c >= ' ' && c <= '~'; });
}

/// As many bytes as fit, without cutting a character in two.
std::string_view first_piece(std::string_view text, std::size_t bytes_max) {
  std::size_t size = std::min(text.size(), bytes_max);
  const auto continues = [&] {
    return size < text.size() && (static_cast<unsigned char>(text[size]) & 0xC0U) == 0x80U;
  };
  while (size > 1 && continues()) --size;
  return text.substr(0, size);
}

/// RFC 2047: encoded words, one a line.
std::string encoded_header(std::string_view text) {
  if (is_printable_ascii(text) && text.size() <= kEncodedWordBytes * 3 / 2) {
    return std::string{text};
  }
  std::string header;
  while (!text.empty()) {
    const std::string_view piece = first_piece(text, kEncodedWordBytes);
    header += fmt::format("{}=?utf-8?B?{}?=", header.empty() ? "" : "\r\n ", base64(piece));
    text.remove_prefix(piece.size());
  }
  return header;
}

std::string encoded_body(std::string_view text) {
  std::string body;
  while (!text.empty()) {
    const std::string_view piece = text.substr(0, kEncodedLineBytes);
    body += base64(piece) + "\r\n";
    text.remove_prefix(piece.size());
  }
  return body;
}

}  // namespace

std::string mail_text(const Mail& mail) {
  const std::string domain = mail.from.substr(mail.from.find('@') + 1);
  return fmt::format(
      "From: {}\r\nTo: {}\r\nSubject: {}\r\nDate: {}\r\nMessage-ID: <{}@{}>\r\n"
      "MIME-Version: 1.0\r\nContent-Type: text/plain; charset=utf-8\r\n"
      "Content-Transfer-Encoding: base64\r\nAuto-Submitted: auto-generated\r\n\r\n{}",
      mail.from, fmt::join(mail.to, ",\r\n "), encoded_header(printable(mail.subject)),
      fmt::format("{:%a, %d %b %Y %T} +0000",
                  fmt::gmtime(std::chrono::system_clock::to_time_t(mail.date))),
      mail.id, domain, encoded_body(printable(mail.text, "\n\t")));
}

}  // namespace recald::delivery
