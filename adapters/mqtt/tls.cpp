#include "adapters/mqtt/tls.hpp"

#include <fmt/format.h>
#include <openssl/err.h>
#include <openssl/x509v3.h>

#include <cstring>

namespace recald::mqtt {
namespace {

/// The first thing that OpenSSL has to say, which is the cause of the others.
std::string openssl_reason() {
  const unsigned long code = ERR_get_error();
  ERR_clear_error();
  if (ERR_SYSTEM_ERROR(code)) return std::strerror(ERR_GET_REASON(code));
  const char* const reason = ERR_reason_error_string(code);
  return reason != nullptr ? reason : "OpenSSL does not say why";
}

tl::unexpected<Error> unreadable(const char* what, const std::filesystem::path& file) {
  return failure(ErrorCode::io_failed,
                 fmt::format("{} {} cannot be used: {}", what, file.string(), openssl_reason()));
}

/// OpenSSL would ask at the terminal.
int no_passphrase(char*, int, int, void*) { return -1; }

bool demand_host(SSL_CTX* context, const std::string& host) {
  X509_VERIFY_PARAM* const demands = SSL_CTX_get0_param(context);
  X509_VERIFY_PARAM_set_hostflags(demands, X509_CHECK_FLAG_NO_PARTIAL_WILDCARDS);
  return X509_VERIFY_PARAM_set1_ip_asc(demands, host.c_str()) == 1 ||
         X509_VERIFY_PARAM_set1_host(demands, host.c_str(), host.size()) == 1;
}

int keep_fault(int is_good, X509_STORE_CTX* store) {
  if (is_good == 1) return is_good;
  const void* const tls = X509_STORE_CTX_get_ex_data(store, SSL_get_ex_data_X509_STORE_CTX_idx());
  SSL_CTX* const context = SSL_get_SSL_CTX(static_cast<const SSL*>(tls));
  *static_cast<long*>(SSL_CTX_get_app_data(context)) = X509_STORE_CTX_get_error(store);
  return is_good;
}

}  // namespace

Result<TlsContext> make_tls_context(const Broker& broker, long& fault) {
  ERR_clear_error();
  TlsContext context{SSL_CTX_new(TLS_client_method())};
  if (!context || SSL_CTX_set_min_proto_version(context.get(), TLS1_2_VERSION) != 1 ||
      !demand_host(context.get(), broker.host)) {
    return failure(ErrorCode::io_failed, "TLS cannot be set up: " + openssl_reason());
  }
  SSL_CTX_set_app_data(context.get(), &fault);
  SSL_CTX_set_verify(context.get(), SSL_VERIFY_PEER, keep_fault);
  SSL_CTX_set_default_passwd_cb(context.get(), no_passphrase);
  if (broker.trusted_certificate.empty()) {
    SSL_CTX_set_default_verify_paths(context.get());
  } else if (SSL_CTX_load_verify_file(context.get(), broker.trusted_certificate.c_str()) != 1) {
    return unreadable("the trusted certificate", broker.trusted_certificate);
  }
  ERR_clear_error();
  if (broker.certificate_file.empty()) return context;
  if (SSL_CTX_use_certificate_chain_file(context.get(), broker.certificate_file.c_str()) != 1) {
    return unreadable("the certificate", broker.certificate_file);
  }
  // Compares it with the certificate too.
  if (SSL_CTX_use_PrivateKey_file(context.get(), broker.key_file.c_str(), SSL_FILETYPE_PEM) != 1) {
    return unreadable("the key", broker.key_file);
  }
  return context;
}

}  // namespace recald::mqtt
