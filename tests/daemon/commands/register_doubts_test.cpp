/// What people get wrong in register maps, recognised by the values.
#include "daemon/commands/meters/register_doubts.hpp"

#include <gmock/gmock.h>

#include <bit>
#include <limits>

namespace recald::daemon {
namespace {

using modbus::RegisterField;
using modbus::RegisterType;
using modbus::WordOrder;
using modbus::Words;
using std::chrono::minutes;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

constexpr LoadLimits kLimits{.rated_kW = 400.0};

RegisterField field(RegisterType type, const char* unit, WordOrder order = WordOrder::ABCD) {
  return {.name = "it", .address = 10, .format = {.type = type, .order = order}, .unit = unit};
}

Words words_of(float value) {
  const auto bits = std::bit_cast<std::uint32_t>(value);
  return {static_cast<std::uint16_t>(bits >> 16), static_cast<std::uint16_t>(bits & 0xFFFF)};
}

std::string doubt(const RegisterField& of, const Words& words, int address = 10,
                  const LoadLimits& limits = kLimits) {
  return doubt_about(of, {address, words}, 1.0, limits);
}

TEST(RegisterDoubts, WhatCanBeIsNotDoubted) {
  EXPECT_THAT(doubt(field(RegisterType::f32, "kW"), words_of(123.4F)), IsEmpty());
  EXPECT_THAT(doubt(field(RegisterType::f32, "kW"), words_of(-123.4F)), IsEmpty()) << "export";
  EXPECT_THAT(doubt(field(RegisterType::f32, "kW"), words_of(0.0F)), IsEmpty());
  EXPECT_THAT(doubt(field(RegisterType::u32, "kWh"), {0x0001, 0x86A0}), IsEmpty());
  EXPECT_THAT(doubt(field(RegisterType::u32, "C"), {0xFFFF, 0xFFFF}), IsEmpty()) << "not judged";
}

TEST(RegisterDoubts, AnotherOrderOfWordsIsNamed) {
  // 123.4 kW sent low word first and read high word first is next to nothing, or enormous.
  Words swapped = words_of(123.4F);
  std::swap(swapped[0], swapped[1]);
  EXPECT_THAT(doubt(field(RegisterType::f32, "kW"), swapped),
              HasSubstr("it would be 123.4 kW with order CDAB"));
  EXPECT_THAT(doubt(field(RegisterType::u32, "W"), {0xD431, 0x0001}),
              HasSubstr("it would be 119857 W with order CDAB"));
  EXPECT_THAT(doubt(field(RegisterType::f32, "kW", WordOrder::CDAB), words_of(123.4F)),
              HasSubstr("123.4 kW with order ABCD"));
}

TEST(RegisterDoubts, ANanMayBeAnOrderOfWords) {
  const Words words{0x7FC0, 0x42F6};  // low word first: 123.249 kW
  EXPECT_THAT(doubt(field(RegisterType::f32, "kW"), words),
              AllOf(HasSubstr("'it' is not a number"), HasSubstr("kW with order CDAB")));
}

TEST(RegisterDoubts, AShiftedAddressIsNamedWhereItWasReadAlong) {
  // The value stands one register lower than the map says: base 1 was written as base 0.
  Words words = words_of(123.4F);
  words.push_back(0x4000);
  EXPECT_THAT(doubt(field(RegisterType::f32, "kW"), words, 9),
              HasSubstr("123.4 kW one address lower (is the map's base right?)"));
  Words higher = words_of(123.4F);
  higher.insert(higher.begin(), 0x7777);
  EXPECT_THAT(doubt(field(RegisterType::f32, "kW"), higher), HasSubstr("one address higher"));
}

TEST(RegisterDoubts, AMissingSignIsNamed) {
  EXPECT_THAT(doubt(field(RegisterType::u32, "W"), {0xFFFF, 0xFF38}),
              HasSubstr("-200 W with a sign, as i32"));
}

TEST(RegisterDoubts, AnAbsentValueIsNoMistake) {
  RegisterField absent = field(RegisterType::u32, "W");
  absent.format.absent = 0xFFFFFFFF;
  EXPECT_THAT(doubt(absent, {0xFFFF, 0xFFFF}), IsEmpty());
}

TEST(RegisterDoubts, WithoutAnExplanationTheDisplayDecides) {
  const std::string said = doubt(field(RegisterType::u16, "MW"), {900});
  EXPECT_THAT(said, AllOf(HasSubstr("'it' is 900 MW"), HasSubstr("with the meter's display")));
}

TEST(RegisterDoubts, ScalesAndTransformersCount) {
  EXPECT_THAT(doubt(field(RegisterType::u16, "kW"), {300}), IsEmpty());
  EXPECT_THAT(doubt(field(RegisterType::u16, "kW"), {300}, 10, {400.0, 40.0}), Not(IsEmpty()));
  EXPECT_THAT(doubt_about(field(RegisterType::u16, "kW"), {10, Words{300}}, 10.0, kLimits),
              Not(IsEmpty()));
}

// Section 3 of the field guide: a float32 steps by 0.0625 kWh at a million.
TEST(RegisterDoubts, CoarseCountersAreNamedWithWhatTheyCost) {
  const RegisterField counter = field(RegisterType::f32, "kWh");
  EXPECT_THAT(coarseness_of(counter, 0.0625, 20.0, minutes{15}, kLimits),
              AllOf(HasSubstr("steps of 0.0625 kWh"),
                    HasSubstr("1.2 % of the energy of 20 kW in 15"), HasSubstr("64-bit copy")));
  EXPECT_THAT(coarseness_of(counter, 0.0625, 26.0, minutes{15}, kLimits), IsEmpty());
  EXPECT_THAT(coarseness_of(field(RegisterType::u32, "MWh"), 1.0, 100.0, minutes{15}, kLimits),
              HasSubstr("inaccurate"));
  EXPECT_THAT(coarseness_of(field(RegisterType::f32, "kW"), 1000.0, 1.0, minutes{15}, kLimits),
              IsEmpty());
}

}  // namespace
}  // namespace recald::daemon
