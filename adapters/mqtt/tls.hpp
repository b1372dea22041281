/// What a TLS connection to a broker trusts and shows.
#pragma once

#include <openssl/ssl.h>

#include <memory>

#include "adapters/mqtt/message.hpp"
#include "core/result.hpp"

namespace recald::mqtt {

struct FreeTlsContext {
  void operator()(SSL_CTX* context) const { SSL_CTX_free(context); }
};
using TlsContext = std::unique_ptr<SSL_CTX, FreeTlsContext>;

/// TLS 1.2 or later; the broker's certificate must be trusted and be for its host.
/// @param fault  Receives why it is not, an X509_V_ERR; outlives the context's connections, whose
///               own results are gone when the library closes them.
/// @return or io_failed: a certificate or key that cannot be read, or that do not belong together.
[[nodiscard]] Result<TlsContext> make_tls_context(const Broker& broker, long& fault);

}  // namespace recald::mqtt
