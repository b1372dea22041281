#include "adapters/http/certificate.hpp"

#include <openssl/bio.h>
#include <openssl/pem.h>
#include <openssl/x509.h>

#include <ctime>
#include <memory>

namespace recald::http {

Result<metering::Instant> end_of_certificate(const std::filesystem::path& file) {
  const std::unique_ptr<BIO, decltype(&BIO_free)> in{BIO_new_file(file.c_str(), "r"), BIO_free};
  if (!in) {
    return failure(ErrorCode::io_failed, "certificate '" + file.string() + "' cannot be read");
  }
  const std::unique_ptr<X509, decltype(&X509_free)> certificate{
      PEM_read_bio_X509(in.get(), nullptr, nullptr, nullptr), X509_free};
  std::tm end{};
  if (!certificate || ASN1_TIME_to_tm(X509_get0_notAfter(certificate.get()), &end) != 1) {
    return failure(ErrorCode::malformed, "'" + file.string() + "' has no certificate (PEM)");
  }
  return metering::Instant{std::chrono::seconds{::timegm(&end)}};
}

}  // namespace recald::http
