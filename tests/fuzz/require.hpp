/// What a fuzz target demands of what it calls.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <string_view>

namespace recald::fuzz {

/// Ends the run with the sentence; the fuzzer keeps the input that led there.
[[noreturn]] inline void give_up(std::string_view sentence) {
  std::fprintf(stderr, "property broken: %.*s\n", static_cast<int>(sentence.size()),
               sentence.data());
  std::abort();
}

inline void require(bool holds, std::string_view sentence) {
  if (!holds) give_up(sentence);
}

/// What people are told: something, and nothing that moves their cursor or begins another line.
inline void require_sentence(std::string_view message) {
  require(!message.empty(), "an error says something");
  for (const char c : message) {
    const auto byte = static_cast<unsigned char>(c);
    if (byte >= 0x20 && byte != 0x7F) continue;
    give_up("a message has a control character: " + std::string{message});
  }
}

/// Parts of an input, taken one after the other; zeros when it is used up.
class Input {
 public:
  Input(const std::uint8_t* data, std::size_t size) : data_(data), left_(size) {}

  std::uint8_t byte() {
    if (left_ == 0) return 0;
    --left_;
    return *data_++;
  }
  std::uint16_t word() {
    const auto high = byte();
    return static_cast<std::uint16_t>(high << 8 | byte());
  }
  std::uint64_t bits64() {
    std::uint64_t bits = 0;
    for (int i = 0; i < 8; ++i) bits = bits << 8 | byte();
    return bits;
  }
  /// 0…`limit` - 1.
  int below(int limit) { return byte() % limit; }
  [[nodiscard]] const std::uint8_t* rest() const { return data_; }
  [[nodiscard]] std::size_t left() const { return left_; }

 private:
  const std::uint8_t* data_;
  std::size_t left_;
};

inline std::string_view text_of(const std::uint8_t* data, std::size_t size) {
  return {reinterpret_cast<const char*>(data), size};
}

}  // namespace recald::fuzz
