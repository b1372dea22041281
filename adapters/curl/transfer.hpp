/// What all transfers with libcurl have in common: what they own, whom they trust, how they fail.
#pragma once

#include <curl/curl.h>

#include <chrono>
#include <filesystem>
#include <memory>
#include <string>

namespace recald::curl {

struct Close {
  void operator()(CURL* handle) const { curl_easy_cleanup(handle); }
  void operator()(CURLU* url) const { curl_url_cleanup(url); }
  void operator()(curl_slist* list) const { curl_slist_free_all(list); }
};
using Handle = std::unique_ptr<CURL, Close>;
using List = std::unique_ptr<curl_slist, Close>;

struct TransferOptions {
  const char* protocols;  ///< "http,https": no others, whatever the address says.
  /// PEM; trusted instead of what the system trusts. Empty: as the system.
  std::filesystem::path trusted_certificate;
  std::chrono::milliseconds connect_timeout{10'000};
  std::chrono::milliseconds timeout{30'000};  ///< Of the whole transfer.
};

/// A transfer that drops what it receives, on a thread that need not be the first.
/// @return none where there is not enough memory.
[[nodiscard]] Handle open_transfer(const std::string& url, const TransferOptions& options);

/// Appends a line, or leaves it out where there is not enough memory.
void add(List& list, const std::string& line);

struct Outcome {
  CURLcode code;
  std::string why;  ///< In libcurl's words; empty: nothing went wrong.
};

/// Blocks until the transfer is over.
[[nodiscard]] Outcome perform(const Handle& handle);

}  // namespace recald::curl
