#include "adapters/curl/transfer.hpp"

#include <cstring>

namespace recald::curl {
namespace {

std::size_t drop(char*, std::size_t, std::size_t count, void*) { return count; }

}  // namespace

Handle open_transfer(const std::string& url, const TransferOptions& options) {
  static const CURLcode initialised = curl_global_init(CURL_GLOBAL_DEFAULT);
  Handle handle{initialised == CURLE_OK ? curl_easy_init() : nullptr};
  if (!handle) return handle;
  CURL* const easy = handle.get();
  curl_easy_setopt(easy, CURLOPT_URL, url.c_str());
  curl_easy_setopt(easy, CURLOPT_PROTOCOLS_STR, options.protocols);
  curl_easy_setopt(easy, CURLOPT_NOSIGNAL, 1L);
  curl_easy_setopt(easy, CURLOPT_QUICK_EXIT, 1L);  // does not wait for a name server
  curl_easy_setopt(easy, CURLOPT_CONNECTTIMEOUT_MS,
                   static_cast<long>(options.connect_timeout.count()));
  curl_easy_setopt(easy, CURLOPT_TIMEOUT_MS, static_cast<long>(options.timeout.count()));
  curl_easy_setopt(easy, CURLOPT_WRITEFUNCTION, drop);
  if (!options.trusted_certificate.empty()) {
    curl_easy_setopt(easy, CURLOPT_CAINFO, options.trusted_certificate.c_str());
    curl_easy_setopt(easy, CURLOPT_CAPATH, nullptr);
  }
  return handle;
}

void add(List& list, const std::string& line) {
  if (curl_slist* longer = curl_slist_append(list.get(), line.c_str())) {
    (void)list.release();
    list.reset(longer);
  }
}

Outcome perform(const Handle& handle) {
  std::string why(CURL_ERROR_SIZE, '\0');
  curl_easy_setopt(handle.get(), CURLOPT_ERRORBUFFER, why.data());
  const CURLcode code = curl_easy_perform(handle.get());
  curl_easy_setopt(handle.get(), CURLOPT_ERRORBUFFER, nullptr);
  why.resize(std::strlen(why.c_str()));
  if (code != CURLE_OK && why.empty()) why = curl_easy_strerror(code);
  return {code, code == CURLE_OK ? std::string{} : why};
}

}  // namespace recald::curl
