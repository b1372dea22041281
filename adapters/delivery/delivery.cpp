#include "adapters/delivery/delivery.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <memory>
#include <string_view>

#include "adapters/curl/transfer.hpp"
#include "adapters/http/url.hpp"

namespace recald::delivery {
namespace {

using curl::add;
using curl::Handle;
using curl::List;

constexpr std::size_t kAnswerBytes = 500;

/// What servers answer to a message that they will not take another time either: 400, 413, 422 over
/// HTTP, 552 (its length) and 554 (its content) over SMTP.
constexpr std::array kRefusals{400L, 413L, 422L};
constexpr long kMailTooLong = 552;
constexpr long kMailRefused = 554;

int ask_whether_to_stop(void* stop, curl_off_t, curl_off_t, curl_off_t, curl_off_t) {
  return static_cast<const std::stop_token*>(stop)->stop_requested() ? 1 : 0;
}

std::size_t keep_beginning(char* bytes, std::size_t, std::size_t count, void* kept) {
  auto& text = *static_cast<std::string*>(kept);
  text.append(bytes, std::min(count, kAnswerBytes - text.size()));
  return count;
}

std::size_t read_rest(char* to, std::size_t size, std::size_t count, void* rest) {
  auto& text = *static_cast<std::string_view*>(rest);
  const std::size_t taken = std::min(size * count, text.size());
  std::memcpy(to, text.data(), taken);
  text.remove_prefix(taken);
  return taken;
}

/// What both kinds have in common.
Handle begin(const std::string& url, const char* protocols,
             const std::filesystem::path& trusted_certificate, const std::stop_token& stop) {
  Handle handle = curl::open_transfer(
      url, {.protocols = protocols, .trusted_certificate = trusted_certificate});
  if (!handle) return handle;
  curl_easy_setopt(handle.get(), CURLOPT_NOPROGRESS, 0L);
  curl_easy_setopt(handle.get(), CURLOPT_XFERINFOFUNCTION, ask_whether_to_stop);
  curl_easy_setopt(handle.get(), CURLOPT_XFERINFODATA, &stop);
  // The proxy of the environment is for the world outside.
  std::string host = host_of(url);
  if (host.starts_with('[')) host = host.substr(1, host.size() - 2);
  if (http::is_this_machine(host)) curl_easy_setopt(handle.get(), CURLOPT_NOPROXY, "*");
  return handle;
}

Result<void> deliver(const Handle& handle, const std::string& url) {
  const curl::Outcome outcome = curl::perform(handle);
  if (outcome.code == CURLE_OK) return {};
  if (outcome.code == CURLE_ABORTED_BY_CALLBACK) {
    return failure(ErrorCode::cancelled, "the delivery was stopped");
  }
  long status = 0;
  curl_easy_getinfo(handle.get(), CURLINFO_RESPONSE_CODE, &status);
  const bool is_refused = status == kMailTooLong || status == kMailRefused;
  return failure(is_refused ? ErrorCode::out_of_range : ErrorCode::io_failed,
                 fmt::format("{} did not take the message: {}", host_of(url), outcome.why));
}

tl::unexpected<Error> no_handle() {
  return failure(ErrorCode::io_failed, "the message cannot be sent: there is not enough memory");
}

}  // namespace

Result<Answer> post(const Post& post, const std::stop_token& stop) {
  const Handle handle = begin(post.url, "http,https", post.trusted_certificate, stop);
  if (!handle) return no_handle();
  List headers;
  add(headers, "Content-Type: " + post.content_type);
  add(headers, "Expect:");  // none: some servers never answer it
  if (!post.token.empty()) add(headers, "Authorization: Bearer " + post.token);
  for (const std::string& header : post.headers) add(headers, header);
  curl_easy_setopt(handle.get(), CURLOPT_HTTPHEADER, headers.get());
  if (!post.user.empty()) {
    curl_easy_setopt(handle.get(), CURLOPT_HTTPAUTH, static_cast<long>(CURLAUTH_BASIC));
    curl_easy_setopt(handle.get(), CURLOPT_USERNAME, post.user.c_str());
    curl_easy_setopt(handle.get(), CURLOPT_PASSWORD, post.password.c_str());
  }
  curl_easy_setopt(handle.get(), CURLOPT_USERAGENT, "recald");
  curl_easy_setopt(handle.get(), CURLOPT_POSTFIELDS, post.body.data());
  curl_easy_setopt(handle.get(), CURLOPT_POSTFIELDSIZE_LARGE,
                   static_cast<curl_off_t>(post.body.size()));
  Answer answer{};
  curl_easy_setopt(handle.get(), CURLOPT_WRITEFUNCTION, keep_beginning);
  curl_easy_setopt(handle.get(), CURLOPT_WRITEDATA, &answer.body);
  TRY(deliver(handle, post.url));
  curl_easy_getinfo(handle.get(), CURLINFO_RESPONSE_CODE, &answer.status);
  curl_off_t wait_s = 0;
  curl_easy_getinfo(handle.get(), CURLINFO_RETRY_AFTER, &wait_s);
  answer.retry_after = std::chrono::seconds{wait_s};
  return answer;
}

Result<void> post_json(const Webhook& webhook, const std::string& document,
                       const std::stop_token& stop) {
  const auto answer = TRY(post({.url = webhook.url,
                                .token = webhook.token,
                                .user = {},
                                .password = {},
                                .trusted_certificate = webhook.trusted_certificate,
                                .content_type = "application/json",
                                .headers = {},
                                .body = document},
                               stop));
  if (answer.status >= 200 && answer.status < 300) return {};
  const bool is_refused = std::ranges::find(kRefusals, answer.status) != kRefusals.end();
  return failure(is_refused ? ErrorCode::out_of_range : ErrorCode::io_failed,
                 fmt::format("{} did not take the message: it answered with status {}",
                             host_of(webhook.url), answer.status));
}

Result<void> send_mail(const MailServer& server, const Mail& mail, const std::stop_token& stop) {
  const Handle handle = begin(server.url, "smtp,smtps", server.trusted_certificate, stop);
  if (!handle) return no_handle();
  curl_easy_setopt(handle.get(), CURLOPT_USE_SSL,
                   static_cast<long>(server.encrypts ? CURLUSESSL_ALL : CURLUSESSL_NONE));
  if (!server.user.empty()) {
    curl_easy_setopt(handle.get(), CURLOPT_USERNAME, server.user.c_str());
    curl_easy_setopt(handle.get(), CURLOPT_PASSWORD, server.password.c_str());
  }
  List recipients;
  for (const std::string& address : mail.to) add(recipients, address);
  curl_easy_setopt(handle.get(), CURLOPT_MAIL_FROM, mail.from.c_str());
  curl_easy_setopt(handle.get(), CURLOPT_MAIL_RCPT, recipients.get());
  curl_easy_setopt(handle.get(), CURLOPT_MAIL_RCPT_ALLLOWFAILS, 1L);  // one left the company
  const std::string text = mail_text(mail);
  std::string_view rest = text;
  curl_easy_setopt(handle.get(), CURLOPT_UPLOAD, 1L);
  curl_easy_setopt(handle.get(), CURLOPT_READFUNCTION, read_rest);
  curl_easy_setopt(handle.get(), CURLOPT_READDATA, &rest);
  return deliver(handle, server.url);
}

std::string host_of(const std::string& url) {
  constexpr const char* kUnknown = "the server";
  const std::unique_ptr<CURLU, curl::Close> parsed{curl_url()};
  if (curl_url_set(parsed.get(), CURLUPART_URL, url.c_str(), 0) != CURLUE_OK) return kUnknown;
  char* text = nullptr;
  if (curl_url_get(parsed.get(), CURLUPART_HOST, &text, 0) != CURLUE_OK) return kUnknown;
  const std::unique_ptr<char, decltype(&curl_free)> owned{text, curl_free};
  return text;
}

}  // namespace recald::delivery
