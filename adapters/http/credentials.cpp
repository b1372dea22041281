#include "adapters/http/credentials.hpp"

#include <openssl/crypto.h>
#include <openssl/evp.h>

#include <cassert>
#include <fstream>
#include <iterator>
#include <system_error>

#include "adapters/http/ascii.hpp"
#include "adapters/system/files/regular_file.hpp"
#include "adapters/system/files/sha256.hpp"

namespace recald::http {
namespace {

constexpr std::size_t kTokenMin = 16;
constexpr std::streamsize kSecretFileMax = 4096;
constexpr std::string_view kWhiteSpace = " \t\r\n";

std::string digest(std::string_view text) {
  system::Sha256 running;
  running.add(text);
  return running.hex();
}

/// Digests all have the same length, so timing does not even reveal the token's length.
bool is_same(std::string_view a, std::string_view b) {
  const std::string left = digest(a);
  const std::string right = digest(b);
  return CRYPTO_memcmp(left.data(), right.data(), left.size()) == 0;
}

/// The password in a base64-encoded "name:password"; empty if there is no colon.
std::string password_of(std::string_view encoded) {
  if (encoded.empty() || encoded.size() % 4 != 0 || encoded.size() > 1024) return {};
  std::string decoded(encoded.size() / 4 * 3, '\0');
  const int length = EVP_DecodeBlock(reinterpret_cast<unsigned char*>(decoded.data()),
                                     reinterpret_cast<const unsigned char*>(encoded.data()),
                                     static_cast<int>(encoded.size()));
  if (length < 0) return {};
  // EVP_DecodeBlock counts the padding as zero bytes.
  while (encoded.ends_with('=') && !decoded.empty()) {
    decoded.pop_back();
    encoded.remove_suffix(1);
  }
  const std::size_t colon = decoded.find(':');
  return colon == std::string::npos ? std::string{} : decoded.substr(colon + 1);
}

bool may_stand_in_token(char c) {
  const char lower = to_lower(c);
  return (lower >= 'a' && lower <= 'z') || (c >= '0' && c <= '9') ||
         std::string_view{"-._~+/="}.find(c) != std::string_view::npos;
}

/// @param what     "token file", for messages.
/// @param how_to   How to make one.
Result<void> check_permissions(const std::filesystem::path& file, const std::string& what,
                               const char* how_to) {
  using std::filesystem::perms;
  std::error_code error;
  const auto status = std::filesystem::status(file, error);
  if (error || status.type() == std::filesystem::file_type::not_found) {
    return failure(ErrorCode::not_found,
                   what + " '" + file.string() + "' cannot be found; make one with: " + how_to);
  }
  if (auto is_file = system::require_file(file, what); !is_file) return is_file;
  const perms others = perms::group_all | perms::others_all;
  if ((status.permissions() & others) != perms::none) {
    return failure(ErrorCode::invalid_value, what + " '" + file.string() +
                                                 "' can be read by others than its owner; "
                                                 "set its mode with: chmod 600 FILE");
  }
  return {};
}

/// The file's text without surrounding white space. @param how_to  As in check_permissions.
Result<std::string> read_secret(const std::filesystem::path& file, const std::string& what,
                                const char* how_to) {
  TRY(check_permissions(file, what, how_to));
  std::ifstream in{file, std::ios::binary};
  std::string secret(kSecretFileMax, '\0');
  in.read(secret.data(), kSecretFileMax);
  secret.resize(static_cast<std::size_t>(in.gcount()));
  if (in.bad() || (!in && !in.eof())) {
    return failure(ErrorCode::io_failed, what + " '" + file.string() + "' cannot be read");
  }
  secret.erase(secret.find_last_not_of(kWhiteSpace) + 1);
  secret.erase(0, secret.find_first_not_of(kWhiteSpace));
  return secret;
}

}  // namespace

bool carries_token(std::string_view authorization, std::string_view token) {
  assert(!token.empty());
  const std::size_t space = authorization.find(' ');
  if (space == std::string_view::npos) return false;
  const std::string_view scheme = authorization.substr(0, space);
  const std::string_view rest = trimmed(authorization.substr(space));
  if (equals_ignoring_case(scheme, "bearer")) return is_same(rest, token);
  if (equals_ignoring_case(scheme, "basic")) return is_same(password_of(rest), token);
  return false;
}

Result<std::string> read_token_file(const std::filesystem::path& file) {
  auto token = read_secret(file, "token file", "(umask 077; openssl rand -hex 32 > FILE)");
  if (!token) return token;
  if (token->size() < kTokenMin) {
    return failure(ErrorCode::invalid_value,
                   "token file '" + file.string() + "' has a token of " +
                       std::to_string(token->size()) +
                       " characters; at least 16 are needed, such as openssl rand -hex 32 gives");
  }
  for (const char c : *token) {
    if (may_stand_in_token(c)) continue;
    return failure(ErrorCode::invalid_value,
                   "token file '" + file.string() +
                       "' has a character that cannot be sent; letters, digits and -._~+/= can");
  }
  return token;
}

Result<std::string> read_password_file(const std::filesystem::path& file) {
  auto password = read_secret(file, "password file", "(umask 077; cat > FILE)");
  if (!password || (!password->empty() && password->find('\n') == std::string::npos)) {
    return password;
  }
  return failure(ErrorCode::invalid_value,
                 "password file '" + file.string() + "' must have one line, which is the password");
}

}  // namespace recald::http
