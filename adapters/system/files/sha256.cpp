#include "adapters/system/files/sha256.hpp"

#include <openssl/evp.h>

#include <array>
#include <fstream>
#include <vector>

namespace recald::system {

struct Sha256::Context {
  EVP_MD_CTX* digest = EVP_MD_CTX_new();
  ~Context() { EVP_MD_CTX_free(digest); }
};

Sha256::Sha256() : context_(std::make_unique<Context>()) {
  EVP_DigestInit_ex(context_->digest, EVP_sha256(), nullptr);
}

Sha256::~Sha256() = default;

void Sha256::add(std::string_view bytes) {
  EVP_DigestUpdate(context_->digest, bytes.data(), bytes.size());
}

Result<void> Sha256::add_file(const std::filesystem::path& file) {
  std::ifstream in{file, std::ios::binary};
  if (!in) return failure(ErrorCode::not_found, "cannot open '" + file.string() + "'");
  std::vector<char> chunk(1 << 16);
  while (in) {
    in.read(chunk.data(), static_cast<std::streamsize>(chunk.size()));
    add({chunk.data(), static_cast<std::size_t>(in.gcount())});
  }
  if (in.bad()) return failure(ErrorCode::io_failed, "cannot read '" + file.string() + "'");
  return {};
}

std::string Sha256::hex() {
  std::array<unsigned char, 32> bytes{};
  EVP_DigestFinal_ex(context_->digest, bytes.data(), nullptr);
  constexpr std::string_view digits = "0123456789abcdef";
  std::string text;
  for (const unsigned char byte : bytes) {
    text += digits[byte >> 4];
    text += digits[byte & 15];
  }
  return text;
}

}  // namespace recald::system
