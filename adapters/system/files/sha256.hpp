/// SHA-256 of the inputs of a result, to tell results apart.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <string_view>

#include "core/result.hpp"

namespace recald::system {

/// An incremental digest, computed by OpenSSL.
class Sha256 {
 public:
  Sha256();
  ~Sha256();
  Sha256(const Sha256&) = delete;
  Sha256& operator=(const Sha256&) = delete;

  void add(std::string_view bytes);
  /// @return not_found or io_failed with the file's name.
  [[nodiscard]] Result<void> add_file(const std::filesystem::path& file);
  /// 64 lower-case hex digits. Finishes the digest.
  [[nodiscard]] std::string hex();

 private:
  struct Context;
  std::unique_ptr<Context> context_;
};

}  // namespace recald::system
