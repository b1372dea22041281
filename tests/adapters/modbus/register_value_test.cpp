#include "adapters/modbus/register_value.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>

namespace recald::modbus::register_value_test {
namespace {

using ::testing::HasSubstr;

/// Register words of a value whose bytes, highest first, are `bytes`, as each order sends them.
/// Written out by hand so that no shift of the decoder meets its mirror image.
struct Sent {
  WordOrder order;
  std::vector<std::uint16_t> words;
};

const std::array kAllOrders{WordOrder::ABCD, WordOrder::CDAB, WordOrder::BADC, WordOrder::DCBA};

std::vector<Sent> sent_32(std::uint8_t a, std::uint8_t b, std::uint8_t c, std::uint8_t d) {
  const auto word = [](std::uint8_t high, std::uint8_t low) {
    return static_cast<std::uint16_t>(high * 256 + low);
  };
  return {{WordOrder::ABCD, {word(a, b), word(c, d)}},
          {WordOrder::CDAB, {word(c, d), word(a, b)}},
          {WordOrder::BADC, {word(b, a), word(d, c)}},
          {WordOrder::DCBA, {word(d, c), word(b, a)}}};
}

double decoded(const Sent& sent, RegisterType type) {
  const auto value = decode(sent.words, {.type = type, .order = sent.order});
  EXPECT_TRUE(value.has_value());
  return value ? value->value : std::numeric_limits<double>::quiet_NaN();
}

TEST(RegisterValue, WordOrderEach) {
  for (const Sent& sent : sent_32(0x00, 0x01, 0x02, 0x03)) {
    SCOPED_TRACE(std::string{to_string(sent.order)});
    EXPECT_EQ(decoded(sent, RegisterType::u32), 66'051.0);
    EXPECT_EQ(decoded(sent, RegisterType::i32), 66'051.0);
    EXPECT_EQ(decoded(sent, RegisterType::bcd32), 10'203.0);
  }
  // 0xFFFFFF38 is -200 and 4 294 967 096; 0x42F6E979 is 123.456 to the nearest float.
  for (const Sent& sent : sent_32(0xFF, 0xFF, 0xFF, 0x38)) {
    SCOPED_TRACE(std::string{to_string(sent.order)});
    EXPECT_EQ(decoded(sent, RegisterType::u32), 4'294'967'096.0);
    EXPECT_EQ(decoded(sent, RegisterType::i32), -200.0);
  }
  for (const Sent& sent : sent_32(0x42, 0xF6, 0xE9, 0x79)) {
    SCOPED_TRACE(std::string{to_string(sent.order)});
    EXPECT_FLOAT_EQ(static_cast<float>(decoded(sent, RegisterType::f32)), 123.456f);
  }
}

TEST(RegisterValue, WordOrderEachOf64Bits) {
  const std::array<std::vector<std::uint16_t>, 4> one_to_eight{{
      {0x0102, 0x0304, 0x0506, 0x0708},
      {0x0708, 0x0506, 0x0304, 0x0102},
      {0x0201, 0x0403, 0x0605, 0x0807},
      {0x0807, 0x0605, 0x0403, 0x0201},
  }};
  for (std::size_t i = 0; i < kAllOrders.size(); ++i) {
    SCOPED_TRACE(std::string{to_string(kAllOrders[i])});
    const Sent sent{kAllOrders[i], one_to_eight[i]};
    EXPECT_EQ(raw_bits(sent.words, sent.order), 0x0102030405060708u);
    EXPECT_EQ(decoded(sent, RegisterType::u64), 72'623'859'790'382'856.0);
    EXPECT_EQ(decoded(sent, RegisterType::i64), 72'623'859'790'382'856.0);
    EXPECT_EQ(decoded(sent, RegisterType::f64), std::bit_cast<double>(0x0102030405060708u));
  }
  EXPECT_EQ(decoded({WordOrder::ABCD, {0xFFFF, 0xFFFF, 0xFFFF, 0xFFFE}}, RegisterType::i64), -2.0);
  // The f64 of 1e12 Wh, where a Siemens meter wraps.
  EXPECT_EQ(decoded({WordOrder::ABCD, {0x426D, 0x1A94, 0xA200, 0x0000}}, RegisterType::f64), 1e12);
}

TEST(RegisterValue, SixteenBitsHaveOnlyAByteOrder) {
  EXPECT_EQ(decoded({WordOrder::ABCD, {0x0102}}, RegisterType::u16), 258.0);
  EXPECT_EQ(decoded({WordOrder::CDAB, {0x0102}}, RegisterType::u16), 258.0);
  EXPECT_EQ(decoded({WordOrder::BADC, {0x0102}}, RegisterType::u16), 513.0);
  EXPECT_EQ(decoded({WordOrder::ABCD, {0xFFFE}}, RegisterType::i16), -2.0);
  EXPECT_EQ(decoded({WordOrder::ABCD, {0x9042}}, RegisterType::bcd16), 9042.0);
}

TEST(RegisterValue, ScaleOffsetAndMask) {
  const std::array<std::uint16_t, 2> words{0x0001, 0x86A0};  // 100 000
  const auto energy = decode(words, {.type = RegisterType::u32, .scale = 0.01});
  ASSERT_TRUE(energy.has_value());
  EXPECT_DOUBLE_EQ(energy->value, 1000.0);
  EXPECT_DOUBLE_EQ(energy->resolution, 0.01);
  const std::array<std::uint16_t, 1> status{0xA123};
  const auto masked = decode(status, {.mask = 0x0FFF});
  ASSERT_TRUE(masked.has_value());
  EXPECT_EQ(masked->value, 0x123);
  const auto shifted = decode(status, {.scale = 0.1, .offset = -50.0});
  ASSERT_TRUE(shifted.has_value());
  EXPECT_DOUBLE_EQ(shifted->value, 0.1 * 0xA123 - 50.0);
}

TEST(RegisterValue, FloatsLoseResolutionAsTheyGrow) {
  const auto resolution = [](float value) {
    const auto bits = std::bit_cast<std::uint32_t>(value);
    const std::array<std::uint16_t, 2> words{static_cast<std::uint16_t>(bits >> 16),
                                             static_cast<std::uint16_t>(bits & 0xFFFF)};
    return decode(words, {.type = RegisterType::f32})->resolution;
  };
  EXPECT_DOUBLE_EQ(resolution(100'000.0f), 0.0078125);
  EXPECT_DOUBLE_EQ(resolution(1'000'000.0f), 0.0625);
}

TEST(RegisterValue, WhatUsuallyMeansNoValueIsKnownInAnyOrder) {
  for (const auto& [type, bits] : std::vector<std::pair<RegisterType, std::uint64_t>>{
           {RegisterType::u16, 0xFFFF},
           {RegisterType::i16, 0x8000},
           {RegisterType::i16, 0x7FFF},
           {RegisterType::u32, 0xFFFF'FFFF},
           {RegisterType::u32, 0x8000'0000},
           {RegisterType::i32, 0x7FFF'FFFF},
           {RegisterType::u64, 0xFFFF'FFFF'FFFF'FFFF},
           {RegisterType::i64, 0x8000'0000'0000'0000},
           {RegisterType::f32, 0x7F7F'FFFF},
           {RegisterType::f64, 0xFFEF'FFFF'FFFF'FFFF}}) {
    EXPECT_TRUE(is_usual_absent(bits, type)) << bits;
    EXPECT_FALSE(is_usual_absent(bits ^ 0x10, type)) << bits;
    EXPECT_FALSE(is_usual_absent(0, type));
  }
  EXPECT_FALSE(is_usual_absent(0xFFFF, RegisterType::u32));
  const auto value = decode(std::vector<std::uint16_t>{0xFFFF, 0xFF7F},
                            {.type = RegisterType::u32, .order = WordOrder::DCBA});
  ASSERT_TRUE(value);
  EXPECT_EQ(value->bits, 0x7FFF'FFFFu);
}

TEST(RegisterValue, SentinelsAreNoValues) {
  const auto fault = [](std::vector<std::uint16_t> words, const ValueFormat& format) {
    const auto value = decode(words, format);
    EXPECT_FALSE(value.has_value());
    return value ? ValueFault::not_finite : value.error();
  };
  EXPECT_EQ(fault({0x8000}, {.type = RegisterType::i16, .absent = 0x8000}), ValueFault::absent);
  EXPECT_EQ(fault({0xFFFF, 0xFFFF, 0xFFFF, 0xFFFF},
                  {.type = RegisterType::u64, .absent = 0xFFFF'FFFF'FFFF'FFFFu}),
            ValueFault::absent);
  EXPECT_EQ(fault({0x7FFF, 0xFFFF}, {.type = RegisterType::i32, .absent = 0x7FFF'FFFFu}),
            ValueFault::absent);
  // In the order of its bytes on the wire the sentinel is the same value.
  EXPECT_EQ(fault({0xFFFF, 0x7FFF},
                  {.type = RegisterType::i32, .order = WordOrder::CDAB, .absent = 0x7FFF'FFFFu}),
            ValueFault::absent);
  EXPECT_EQ(fault({0x8000}, {.mask = 0x00FF, .absent = 0x8000}), ValueFault::absent);
  EXPECT_TRUE(
      decode(std::vector<std::uint16_t>{0x8001}, {.type = RegisterType::i16, .absent = 0x8000})
          .has_value());
}

TEST(RegisterValue, NanInfinityAndNoDigitsAreNoValues) {
  const std::array<std::uint16_t, 2> nan{0x7FC0, 0x0000};
  const std::array<std::uint16_t, 2> infinity{0xFF80, 0x0000};
  const std::array<std::uint16_t, 4> nan64{0x7FF8, 0, 0, 0};
  EXPECT_EQ(decode(nan, {.type = RegisterType::f32}).error(), ValueFault::not_finite);
  EXPECT_EQ(decode(infinity, {.type = RegisterType::f32}).error(), ValueFault::not_finite);
  EXPECT_EQ(decode(nan64, {.type = RegisterType::f64}).error(), ValueFault::not_finite);
  const std::array<std::uint16_t, 1> letters{0x00A0};
  EXPECT_EQ(decode(letters, {.type = RegisterType::bcd16}).error(), ValueFault::not_bcd);
  const std::array<std::uint16_t, 4> huge{0x7FEF, 0xFFFF, 0xFFFF, 0xFFFF};
  EXPECT_EQ(decode(huge, {.type = RegisterType::f64, .scale = 1000.0}).error(),
            ValueFault::not_finite);
}

// Beyond the largest value there is no step, below it there is.
TEST(RegisterValue, TheLargestFloatHasAResolution) {
  const std::array<std::uint16_t, 2> largest{0x7F7F, 0xFFFF};
  EXPECT_EQ(decode(largest, {.type = RegisterType::f32})->resolution, std::ldexp(1.0, 104));
  const std::array<std::uint16_t, 4> largest64{0x7FEF, 0xFFFF, 0xFFFF, 0xFFFF};
  EXPECT_EQ(decode(largest64, {.type = RegisterType::f64})->resolution, std::ldexp(1.0, 971));
}

TEST(RegisterValue, NamesOfTypesAndOrders) {
  for (const std::string_view name :
       {"u16", "i16", "u32", "i32", "u64", "i64", "f32", "f64", "bcd16", "bcd32"}) {
    const auto type = parse_register_type(name);
    ASSERT_TRUE(type.has_value()) << name;
    EXPECT_EQ(to_string(*type), name);
  }
  for (const std::string_view name : {"ABCD", "CDAB", "BADC", "DCBA"}) {
    const auto order = parse_word_order(name);
    ASSERT_TRUE(order.has_value()) << name;
    EXPECT_EQ(to_string(*order), name);
  }
  EXPECT_THAT(parse_register_type("uint32").error().message,
              HasSubstr("'uint32' is no register type; it must be one of u16, i16"));
  EXPECT_THAT(parse_word_order("big").error().message, HasSubstr("one of ABCD, CDAB, BADC, DCBA"));
}

}  // namespace
}  // namespace recald::modbus::register_value_test
