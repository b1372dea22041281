/// A key and a certificate of a test's own, good for a day.
#pragma once

#include <openssl/evp.h>
#include <openssl/pem.h>
#include <openssl/x509.h>

#include <cstdio>
#include <filesystem>
#include <memory>
#include <stdexcept>

#include "adapters/http/server.hpp"

namespace recald::testing {

/// Writes NAME.pem and NAME.key, for a host called `name`, good for so many seconds from now.
inline http::TlsFiles write_self_signed(const std::filesystem::path& folder,
                                        const std::string& name, long good_s = 86'400) {
  const http::TlsFiles files{folder / (name + ".pem"), folder / (name + ".key")};
  const std::unique_ptr<EVP_PKEY, decltype(&EVP_PKEY_free)> key{EVP_EC_gen("P-256"), EVP_PKEY_free};
  const std::unique_ptr<X509, decltype(&X509_free)> certificate{X509_new(), X509_free};
  X509* const x509 = certificate.get();
  ASN1_INTEGER_set(X509_get_serialNumber(x509), 1);
  X509_gmtime_adj(X509_getm_notBefore(x509), -3600);
  X509_gmtime_adj(X509_getm_notAfter(x509), good_s);
  X509_set_pubkey(x509, key.get());
  X509_NAME* const subject = X509_get_subject_name(x509);
  X509_NAME_add_entry_by_txt(subject, "CN", MBSTRING_ASC,
                             reinterpret_cast<const unsigned char*>(name.c_str()), -1, -1, 0);
  X509_set_issuer_name(x509, subject);
  if (X509_sign(x509, key.get(), EVP_sha256()) == 0) throw std::runtime_error("no certificate");
  const auto write = [](const std::filesystem::path& file, auto put) {
    const std::unique_ptr<FILE, decltype(&std::fclose)> out{std::fopen(file.c_str(), "w"),
                                                            std::fclose};
    if (!out || put(out.get()) == 0) throw std::runtime_error("cannot write " + file.string());
  };
  write(files.certificate, [&](FILE* out) { return PEM_write_X509(out, x509); });
  write(files.key, [&](FILE* out) {
    return PEM_write_PrivateKey(out, key.get(), nullptr, nullptr, 0, nullptr, nullptr);
  });
  return files;
}

}  // namespace recald::testing
