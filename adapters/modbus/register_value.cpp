#include "adapters/modbus/register_value.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <array>
#include <bit>
#include <cassert>
#include <cmath>
#include <limits>

namespace recald::modbus {
namespace {

constexpr std::array<std::string_view, 10> kTypeNames{"u16", "i16", "u32", "i32",   "u64",
                                                      "i64", "f32", "f64", "bcd16", "bcd32"};
constexpr std::array<std::string_view, 4> kOrderNames{"ABCD", "CDAB", "BADC", "DCBA"};

template <class Enum, std::size_t N>
Result<Enum> parse_name(std::string_view text, const std::array<std::string_view, N>& names,
                        std::string_view what) {
  for (std::size_t i = 0; i < N; ++i) {
    if (names[i] == text) return static_cast<Enum>(i);
  }
  return failure(ErrorCode::invalid_value, fmt::format("'{}' is no {}; it must be one of {}", text,
                                                       what, fmt::join(names, ", ")));
}

bool is_low_word_first(WordOrder order) {
  return order == WordOrder::CDAB || order == WordOrder::DCBA;
}

bool has_swapped_bytes(WordOrder order) {
  return order == WordOrder::BADC || order == WordOrder::DCBA;
}

/// The value of a signed type; shifting up and down again extends the sign bit.
double as_signed(std::uint64_t bits, int width) {
  const int unused = 64 - width;
  return static_cast<double>(static_cast<std::int64_t>(bits << unused) >> unused);
}

std::optional<double> as_bcd(std::uint64_t bits) {
  double value = 0.0;
  double place = 1.0;
  for (; bits != 0; bits >>= 4, place *= 10.0) {
    const auto digit = bits & 0xF;
    if (digit > 9) return {};
    value += place * static_cast<double>(digit);
  }
  return value;
}

/// Distance to the next value away from zero; for the largest value, to the next one below.
template <class Float>
double step_of(Float value) {
  const Float size = std::abs(value);
  constexpr Float kLargest = std::numeric_limits<Float>::max();
  const Float neighbour = std::nextafter(size, size < kLargest ? kLargest : Float{0});
  return std::abs(static_cast<double>(neighbour) - static_cast<double>(size));
}

struct Raw {
  double value;
  double step = 1.0;
};

tl::expected<Raw, ValueFault> interpret(std::uint64_t bits, RegisterType type) {
  switch (type) {
    case RegisterType::u16:
    case RegisterType::u32:
    case RegisterType::u64:
      return Raw{static_cast<double>(bits)};
    case RegisterType::i16:
    case RegisterType::i32:
    case RegisterType::i64:
      return Raw{as_signed(bits, 16 * word_count(type))};
    case RegisterType::bcd16:
    case RegisterType::bcd32: {
      const auto value = as_bcd(bits);
      if (!value) return tl::unexpected(ValueFault::not_bcd);
      return Raw{*value};
    }
    case RegisterType::f32: {
      const float value = std::bit_cast<float>(static_cast<std::uint32_t>(bits));
      if (!std::isfinite(value)) return tl::unexpected(ValueFault::not_finite);
      return Raw{static_cast<double>(value), step_of(value)};
    }
    case RegisterType::f64: {
      const double value = std::bit_cast<double>(bits);
      if (!std::isfinite(value)) return tl::unexpected(ValueFault::not_finite);
      return Raw{value, step_of(value)};
    }
  }
  assert(false && "every type is interpreted");
  return tl::unexpected(ValueFault::not_finite);
}

}  // namespace

Result<RegisterType> parse_register_type(std::string_view text) {
  return parse_name<RegisterType>(text, kTypeNames, "register type");
}

Result<WordOrder> parse_word_order(std::string_view text) {
  return parse_name<WordOrder>(text, kOrderNames, "word order");
}

std::string_view to_string(RegisterType type) { return kTypeNames[static_cast<std::size_t>(type)]; }

std::string_view to_string(WordOrder order) { return kOrderNames[static_cast<std::size_t>(order)]; }

int word_count(RegisterType type) {
  switch (type) {
    case RegisterType::u16:
    case RegisterType::i16:
    case RegisterType::bcd16:
      return 1;
    case RegisterType::u32:
    case RegisterType::i32:
    case RegisterType::f32:
    case RegisterType::bcd32:
      return 2;
    case RegisterType::u64:
    case RegisterType::i64:
    case RegisterType::f64:
      return 4;
  }
  assert(false && "every type has a width");
  return 1;
}

std::optional<double> wraps_at(const ValueFormat& format) {
  if (format.mask || format.offset != 0.0) return {};
  switch (format.type) {
    case RegisterType::u16:
      return 65'536.0 * format.scale;
    case RegisterType::u32:
      return 4'294'967'296.0 * format.scale;
    case RegisterType::bcd16:
      return 1e4 * format.scale;
    case RegisterType::bcd32:
      return 1e8 * format.scale;
    default:
      return {};
  }
}

std::vector<std::uint16_t> float64_words(double value) {
  const auto bits = std::bit_cast<std::uint64_t>(value);
  std::vector<std::uint16_t> words;
  for (const int shift : {48, 32, 16, 0}) {
    words.push_back(static_cast<std::uint16_t>(bits >> shift));
  }
  return words;
}

std::uint64_t raw_bits(std::span<const std::uint16_t> words, WordOrder order) {
  std::uint64_t bits = 0;
  for (std::size_t i = 0; i < words.size(); ++i) {
    std::uint16_t word = words[is_low_word_first(order) ? words.size() - 1 - i : i];
    if (has_swapped_bytes(order)) word = static_cast<std::uint16_t>(word << 8 | word >> 8);
    bits = bits << 16 | word;
  }
  return bits;
}

tl::expected<DecodedValue, ValueFault> decode(std::span<const std::uint16_t> words,
                                              const ValueFormat& format) {
  assert(words.size() == static_cast<std::size_t>(word_count(format.type)));
  const std::uint64_t sent = raw_bits(words, format.order);
  std::uint64_t bits = sent;
  // The sentinel is what the device sends, so it is compared before the mask is applied.
  if (format.absent == bits) return tl::unexpected(ValueFault::absent);
  if (format.mask) bits &= *format.mask;
  const auto raw = TRY(interpret(bits, format.type));
  const double value = raw.value * format.scale + format.offset;
  if (!std::isfinite(value)) return tl::unexpected(ValueFault::not_finite);
  return DecodedValue{value, raw.step * std::abs(format.scale), sent};
}

bool is_usual_absent(std::uint64_t bits, RegisterType type) {
  const int width = 16 * word_count(type);
  const std::uint64_t ones = ~std::uint64_t{0} >> (64 - width);
  const std::uint64_t sign = ones ^ (ones >> 1);
  switch (type) {
    case RegisterType::u16:
    case RegisterType::i16:
    case RegisterType::u32:
    case RegisterType::i32:
    case RegisterType::u64:
    case RegisterType::i64:
      return bits == ones || bits == sign || bits == (ones ^ sign);
    case RegisterType::f32:
      return (bits & ~sign) == std::bit_cast<std::uint32_t>(std::numeric_limits<float>::max());
    case RegisterType::f64:
      return (bits & ~sign) == std::bit_cast<std::uint64_t>(std::numeric_limits<double>::max());
    case RegisterType::bcd16:
    case RegisterType::bcd32:
      return false;  // all ones are no digits
  }
  assert(false && "every type is known");
  return false;
}

}  // namespace recald::modbus
