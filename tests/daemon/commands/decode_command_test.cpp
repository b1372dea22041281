/// `recald decode` as somebody types it beside a meter.
#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "tests/daemon/command_line.hpp"

namespace recald::daemon {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;
using testing::Outcome;
using testing::run;
using ::testing::StartsWith;

// ABB B23, active import at 0x5000: 0x186A0 steps of 0.01 kWh.
constexpr const char* kReply = "0001 0000 000B 01 03 08 0000 0000 0001 86A0";
constexpr const char* kRequest = "0001 0000 0006 01 03 5000 0004";

TEST(DecodeCommand, ExplainsAReplyByteByByteWithItsFields) {
  const Outcome done = run({"decode", "--map", "abb-b23", "--hex", kReply, "--request", kRequest});
  EXPECT_EQ(done.exit_code, 0) << done.err;
  EXPECT_THAT(done.out, HasSubstr("TCP frame, 17 bytes"));
  EXPECT_THAT(done.out, HasSubstr("    6  01           unit 1"));
  EXPECT_THAT(done.out, HasSubstr("register @20483 = 34464"));
  EXPECT_THAT(done.out,
              HasSubstr("@20480  energy_import            0000 0000 0001 86A0  1000 kWh"));
  EXPECT_THAT(done.err, IsEmpty());
}

TEST(DecodeCommand, BareRegistersNeedAnAddress) {
  const Outcome unknown = run({"decode", "--map", "abb-b23", "--hex", "0000 0000 0001 86A0"});
  EXPECT_EQ(unknown.exit_code, 0);
  EXPECT_THAT(unknown.out, HasSubstr("give --request or --at"));
  const Outcome known =
      run({"decode", "--map", "abb-b23", "--hex", "0000 0000 0001 86A0", "--at", "0x5000"});
  EXPECT_THAT(known.out, HasSubstr("1000 kWh"));
  const Outcome elsewhere =
      run({"decode", "--map", "abb-b23", "--hex", "0000 0000 0001 86A0", "--at", "0"});
  EXPECT_THAT(elsewhere.out, HasSubstr("registers @0 to @3 contain none of its fields"));
}

TEST(DecodeCommand, SaysWhyAFieldHasNoValue) {
  const Outcome absent =
      run({"decode", "--map", "abb-b23", "--hex", "FFFF FFFF FFFF FFFF 0000", "--at", "0x5000"});
  EXPECT_THAT(absent.out, HasSubstr("absent: the device reports no value"));
  EXPECT_THAT(absent.out, HasSubstr("only 1 of its 4 registers are here")) << "the next field";
  const Outcome unscaled = run({"decode", "--map", "sunspec-meter", "--hex", "FF9C", "--at", "18"});
  EXPECT_THAT(unscaled.out, HasSubstr("its power of ten, 'power_factor_of_ten', is not in these"));
  const Outcome scaled =
      run({"decode", "--map", "sunspec-meter", "--hex", "FF9C 0000 0000 0000 0001", "--at", "18"});
  EXPECT_THAT(scaled.out, HasSubstr("-1000 W"));
}

TEST(DecodeCommand, AnExceptionIsAGoodFrame) {
  const Outcome done = run(
      {"decode", "--map", "abb-b23", "--hex", "0001 0000 0003 01 83 0B", "--request", kRequest});
  EXPECT_EQ(done.exit_code, 0) << done.err;
  EXPECT_THAT(done.out, HasSubstr("exception 11 (gateway: the device does not respond)"));
}

TEST(DecodeCommand, WhatDoesNotFitIsSaidAndFails) {
  const std::pair<std::vector<std::string>, const char*> cases[] = {
      {{"--hex", "0001 0000 000B 02 03 08 0000 0000 0001 86A0", "--request", kRequest},
       "unit 2 answered for unit 1"},
      {{"--hex", "0002 0000 000B 01 03 08 0000 0000 0001 86A0", "--request", kRequest},
       "transaction 2 came for transaction 1"},
      {{"--hex", "0001 0000 000B 01 04 08 0000 0000 0001 86A0"},
       "the frame has function 4, but map 'abb-b23' uses function 3"},
      {{"--hex", "0000 0001", "--request", kRequest}, "reads 4 registers, but there are 2 here"},
      {{"--hex", "0001 0000 000B 01 03 08 0000 0000 0001 86"}, "cut short"},
      {{"--hex", kReply, "--request", "01 03 50 00 00 04 55 09"},
       "the request is rtu, but the reply is tcp"},
  };
  for (const auto& [given, words] : cases) {
    std::vector<std::string> arguments{"decode", "--map", "abb-b23"};
    arguments.insert(arguments.end(), given.begin(), given.end());
    const Outcome done = run(arguments);
    EXPECT_EQ(done.exit_code, 1) << given[1];
    EXPECT_THAT(done.err, HasSubstr(words)) << given[1];
    EXPECT_THAT(done.out, Not(IsEmpty())) << "it is explained all the same";
  }
}

TEST(DecodeCommand, WrongUsageIsOneSentence) {
  const std::pair<std::vector<std::string>, const char*> cases[] = {
      {{"--map", "abb-b23", "--hex", "01 0G"}, "recald: --hex: character 5 is 'G'"},
      {{"--map", "abb-b23", "--hex", "00", "--at", "70000"}, "--at is '70000'"},
      {{"--map", "abb-b23", "--hex", "00", "--at", "0x"}, "--at is '0x'"},
      {{"--map", "abb-b23", "--hex", "00", "--request", "00"}, "--request: a read request has"},
      {{"--map", "abb-b23", "--hex", kReply, "--request", kRequest, "--at", "1"},
       "--at says 1 but --request says 20480"},
  };
  for (const auto& [given, words] : cases) {
    std::vector<std::string> arguments{"decode"};
    arguments.insert(arguments.end(), given.begin(), given.end());
    const Outcome done = run(arguments);
    EXPECT_EQ(done.exit_code, 2) << done.err;
    EXPECT_THAT(done.err, HasSubstr(words));
    EXPECT_THAT(done.out, IsEmpty());
  }
  const Outcome nobody = run({"decode", "--map", "abb-b32", "--hex", "00"});
  EXPECT_EQ(nobody.exit_code, 1);
  EXPECT_THAT(nobody.err, HasSubstr("did you mean 'abb-b23'"));
}

TEST(DecodeCommand, JsonIsOneObject) {
  const Outcome done =
      run({"decode", "--map", "abb-b23", "--hex", kReply, "--request", kRequest, "--json"});
  const auto json = nlohmann::json::parse(done.out);
  EXPECT_EQ(json.at("framing"), "tcp");
  EXPECT_EQ(json.at("unit"), 1);
  EXPECT_EQ(json.at("exception"), nullptr);
  EXPECT_EQ(json.at("address"), 0x5000);
  EXPECT_EQ(json.at("parts").size(), 6u);
  EXPECT_EQ(json.at("fields").at(0).at("name"), "energy_import");
  EXPECT_EQ(json.at("fields").at(0).at("value"), 1000.0);
  EXPECT_TRUE(json.at("problems").empty());
}

}  // namespace
}  // namespace recald::daemon
