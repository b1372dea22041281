#include "adapters/modbus/register_map.hpp"

#include <gmock/gmock.h>

#include <set>

namespace recald::modbus::register_map_test {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::SizeIs;

RegisterField field(const std::string& name, int address, RegisterType type) {
  return {.name = name,
          .address = static_cast<std::uint16_t>(address),
          .format = {.type = type},
          .unit = "kWh"};
}

std::vector<PlannedRead> planned(const std::vector<RegisterField>& fields,
                                 const ReadLimits& limits = {}) {
  const auto reads = plan_reads(fields, Function::read_holding_registers, limits);
  EXPECT_TRUE(reads.has_value());
  return reads.value_or(std::vector<PlannedRead>{});
}

TEST(ReadPlan, ReadsOverSmallHolesInOneGo) {
  const auto reads = planned({field("b", 18, RegisterType::u32), field("a", 0, RegisterType::u32)});
  ASSERT_THAT(reads, SizeIs(1));
  EXPECT_EQ(reads[0].address, 0);
  EXPECT_EQ(reads[0].count, 20);
  EXPECT_THAT(reads[0].fields, ElementsAre(1, 0));
}

TEST(ReadPlan, HolesThatAreTooWidePartTheReads) {
  const std::vector<RegisterField> fields{field("a", 0, RegisterType::u32),
                                          field("b", 18, RegisterType::u32),
                                          field("c", 37, RegisterType::u16)};
  const auto reads = planned(fields);  // holes of 16 and of 17
  ASSERT_THAT(reads, SizeIs(2));
  EXPECT_EQ(reads[0].count, 20);
  EXPECT_EQ(reads[1].address, 37);
  EXPECT_THAT(planned(fields, {.gap_max = 15}), SizeIs(3));
  EXPECT_THAT(planned(fields, {.gap_max = 17}), SizeIs(1));
}

TEST(ReadPlan, NeverSplitsAValueAtTheLimit) {
  std::vector<RegisterField> fields;
  for (int i = 0; i < 40; ++i) {
    fields.push_back(field("f" + std::to_string(i), 4 * i, RegisterType::u64));
  }
  const auto reads = planned(fields, {.registers_max = 50});  // 12 values of 4, not 12.5
  std::set<std::size_t> brought;
  for (const PlannedRead& read : reads) {
    EXPECT_LE(read.count, 48);
    for (const std::size_t i : read.fields) {
      EXPECT_GE(fields[i].address, read.address);
      EXPECT_LE(fields[i].end(), read.address + read.count);
      EXPECT_TRUE(brought.insert(i).second) << i;
    }
  }
  EXPECT_THAT(brought, SizeIs(fields.size()));
  EXPECT_THAT(reads, SizeIs(4));
}

TEST(ReadPlan, OneRequestPerField) {
  const auto reads = planned({field("a", 0, RegisterType::u32), field("b", 2, RegisterType::u32)},
                             {.one_request_per_field = true});
  ASSERT_THAT(reads, SizeIs(2));
  EXPECT_EQ(reads[0].count, 2);
}

// SunSpec 203: the power of ten stands 8 registers behind the energy and may change with the load.
TEST(ReadPlan, ValueAndItsScaleFactorComeTogether) {
  std::vector<RegisterField> fields{
      field("import", 46, RegisterType::u32), field("export", 38, RegisterType::u32),
      field("factor", 54, RegisterType::i16), field("between", 50, RegisterType::u16)};
  fields[0].scale_factor = "factor";
  fields[1].scale_factor = "factor";
  const auto reads = planned(fields, {.gap_max = 0, .one_request_per_field = true});
  ASSERT_THAT(reads, SizeIs(2));
  EXPECT_THAT(reads[0].fields, ElementsAre(1, 0, 2));
  EXPECT_EQ(reads[0].address, 38);
  EXPECT_EQ(reads[0].count, 17);
  EXPECT_THAT(reads[1].fields, ElementsAre(3));
}

TEST(ReadPlan, WhatBelongsTogetherMayBeTooMuchForTheDevice) {
  std::vector<RegisterField> fields{field("energy", 0, RegisterType::u32),
                                    field("factor", 100, RegisterType::i16)};
  fields[0].scale_factor = "factor";
  const auto reads = plan_reads(fields, Function::read_holding_registers, {.registers_max = 64});
  ASSERT_FALSE(reads.has_value());
  EXPECT_EQ(reads.error().code, ErrorCode::unsupported);
  EXPECT_THAT(reads.error().message, HasSubstr("'energy' to 'factor' must be read together"));
  EXPECT_THAT(reads.error().message, HasSubstr("span 101 registers"));
}

TEST(ReadPlan, OverlappingFieldsShareARead) {
  const auto reads = planned(
      {field("all", 0, RegisterType::u64), field("low", 2, RegisterType::u32)}, {.gap_max = 0});
  ASSERT_THAT(reads, SizeIs(1));
  EXPECT_EQ(reads[0].count, 4);
}

TEST(ReadPlan, DecodesEachFieldWhereItStands) {
  const std::vector<RegisterField> fields{field("a", 10, RegisterType::u16),
                                          field("b", 12, RegisterType::u32)};
  const auto values = decode_read(fields, planned(fields)[0], Words{1, 2, 3, 4});
  ASSERT_THAT(values, SizeIs(2));
  EXPECT_EQ(values[0].value->value, 1.0);
  EXPECT_EQ(values[1].value->value, 3.0 * 65'536.0 + 4.0);
}

TEST(ReadPlan, PowersOfTenMayChangeFromReadToRead) {
  std::vector<RegisterField> fields{field("energy", 0, RegisterType::u16),
                                    field("factor", 1, RegisterType::i16)};
  fields[0].scale_factor = "factor";
  fields[1].format.absent = 0x8000;
  const PlannedRead read = planned(fields)[0];
  const auto energy = [&](const Words& words) { return decode_read(fields, read, words)[0].value; };
  EXPECT_DOUBLE_EQ(energy({1234, 2})->value, 123'400.0);
  EXPECT_DOUBLE_EQ(energy({1234, 2})->resolution, 100.0);
  EXPECT_DOUBLE_EQ(energy({12340, 1})->value, 123'400.0);
  EXPECT_DOUBLE_EQ(energy({1234, 0xFFFF})->value, 123.4);
  EXPECT_EQ(energy({1234, 0x8000}).error(), ValueFault::absent);
  // A factor that no meter means: neither infinite energy nor 0 times infinity.
  EXPECT_EQ(energy({1234, 0x7FFF}).error(), ValueFault::not_finite);
  EXPECT_EQ(energy({0, 0x7FFF}).error(), ValueFault::not_finite);
}

// Each field of a read that a device may refuse has a read of its own, with the factor it needs.
TEST(ReadPlan, ARefusedReadHasOthersInItsPlace) {
  std::vector<RegisterField> fields{
      field("a", 0, RegisterType::u32), field("b", 10, RegisterType::u32),
      field("c", 90, RegisterType::u16), field("sf", 20, RegisterType::i16)};
  fields[1].scale_factor = "sf";
  auto reads = planned(fields);
  ASSERT_THAT(reads, SizeIs(2));
  add_single_reads(reads, fields);
  ASSERT_THAT(reads, SizeIs(4));
  EXPECT_TRUE(reads[0].may_split);
  EXPECT_FALSE(reads[1].may_split);
  EXPECT_THAT(reads[2].fields, ElementsAre(0));
  EXPECT_THAT(reads[3].fields, ElementsAre(1, 3));
  EXPECT_EQ(reads[3].address, 10);
  EXPECT_EQ(reads[3].count, 11);
  for (const std::size_t i : {2u, 3u}) EXPECT_EQ(reads[i].instead_of, 0u);
}

}  // namespace
}  // namespace recald::modbus::register_map_test
