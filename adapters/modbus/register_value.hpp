/// From register words to a value: type, word order, absent values, scale.
///
/// libmodbus has its own decoders, but its releases differ in what "abcd" means. These are tested
/// byte by byte. Plain functions, as in frame.hpp.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <tl/expected.hpp>
#include <vector>

#include "core/result.hpp"

namespace recald::modbus {

enum class RegisterType : std::uint8_t {
  u16,
  i16,
  u32,
  i32,
  u64,
  i64,
  f32,
  f64,
  bcd16,  ///< Four decimal digits, one in each half byte.
  bcd32,  ///< Eight digits.
};

/// The order of a value's bytes, A the highest. For 64 bits the pattern continues: ABCD is
/// ABCDEFGH, CDAB is GHEFCDAB (lowest word first), BADC is BADCFEHG (bytes swapped within words),
/// DCBA is HGFEDCBA.
enum class WordOrder : std::uint8_t { ABCD, CDAB, BADC, DCBA };

[[nodiscard]] Result<RegisterType> parse_register_type(std::string_view text);
[[nodiscard]] Result<WordOrder> parse_word_order(std::string_view text);
[[nodiscard]] std::string_view to_string(RegisterType type);
[[nodiscard]] std::string_view to_string(WordOrder order);

/// Number of registers that a value of this type takes: 1, 2 or 4.
[[nodiscard]] int word_count(RegisterType type);

struct ValueFormat {
  RegisterType type = RegisterType::u16;
  WordOrder order = WordOrder::ABCD;
  double scale = 1.0;  ///< Value = raw · scale + offset, in the field's unit.
  double offset = 0.0;
  std::optional<std::uint64_t> mask;  ///< Unsigned types: bits that belong to the value.
  /// Raw bits that mean "no value", as wide as the type: 0x8000 for an i16.
  std::optional<std::uint64_t> absent;

  bool operator==(const ValueFormat&) const = default;
};

/// Why the words hold no value.
enum class ValueFault : std::uint8_t {
  absent,      ///< The register's sentinel: the device has no value.
  not_finite,  ///< A NaN or an infinity.
  not_bcd,     ///< A half byte above 9.
};

struct DecodedValue {
  double value;  ///< In the field's unit.
  /// The step from this raw value to the next one that the type can hold, scaled: 0.01 kWh for an
  /// integer in units of 0.01 kWh, 0.0625 kWh for a float32 near a million.
  double resolution;
  std::uint64_t bits = 0;  ///< As read: `raw_bits`.
};

/// Whether devices usually send these bits where they have no value: all ones, or the largest or
/// smallest number of a signed type of that width (SunSpec and most others do); of a float the
/// largest finite number, since a NaN is no value anyway. A counter may really pass them.
[[nodiscard]] bool is_usual_absent(std::uint64_t bits, RegisterType type);

/// @pre words.size() == word_count(format.type).
[[nodiscard]] tl::expected<DecodedValue, ValueFault> decode(std::span<const std::uint16_t> words,
                                                            const ValueFormat& format);

/// Where a counter of this format begins again at zero, if it counts to the end of its registers;
/// in the field's unit. Nothing for a float, a signed or a masked type, and for 64 bits, which
/// last.
[[nodiscard]] std::optional<double> wraps_at(const ValueFormat& format);

/// The registers of a 64-bit float, in order ABCD.
[[nodiscard]] std::vector<std::uint16_t> float64_words(double value);

/// The 16, 32 or 64 bits of a value, lowest word last, as compared with `absent` and `mask`.
[[nodiscard]] std::uint64_t raw_bits(std::span<const std::uint16_t> words, WordOrder order);

}  // namespace recald::modbus
