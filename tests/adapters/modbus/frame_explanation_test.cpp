/// Frames from logs and terminals, whole and damaged.
#include "adapters/modbus/frame_explanation.hpp"

#include <gmock/gmock.h>

namespace recald::modbus::frame_explanation_test {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;
using Bytes = std::vector<std::uint8_t>;

Bytes bytes_of(std::string_view text) {
  auto bytes = parse_hex_bytes(text);
  if (!bytes) throw std::runtime_error(bytes.error().message);
  return *bytes;
}

// Unit 17, function 3, three registers: the example of the specification's section 6.3, framed.
const Bytes kTcp = bytes_of("0001 0000 0009 11 03 06 022B 0000 0064");
const Bytes kRtu = [] {
  Bytes frame = bytes_of("11 03 06 022B 0000 0064");
  const std::uint16_t sum = crc16(frame);
  frame.push_back(static_cast<std::uint8_t>(sum & 0xFF));
  frame.push_back(static_cast<std::uint8_t>(sum >> 8));
  return frame;
}();

TEST(HexBytes, AreReadAsPeopleCopyThem) {
  const Bytes expected{0x01, 0x0A, 0xFF};
  for (const char* text : {"010aFF", "01 0A ff", "0x01,0x0A,0xFF", "01:0a:ff", "[01-0A-FF]\n",
                           "0x010AFF", "  01\t0A\r\nFF  "}) {
    const auto bytes = parse_hex_bytes(text);
    ASSERT_TRUE(bytes.has_value()) << text << ": " << bytes.error().message;
    EXPECT_EQ(*bytes, expected) << text;
  }
}

TEST(HexBytes, MistakesAreNamedWhereTheyAre) {
  const std::pair<const char*, const char*> cases[] = {
      {"01 0G", "character 5 is 'G'"},
      {"01 0\x1B", "character 5 is 0x1B"},
      {"01 0", "one digit instead of two"},
      {"0 1", "character 2 is ' '"},
      {"", "no bytes"},
      {" : ", "no bytes"},
  };
  for (const auto& [text, words] : cases) {
    const auto bytes = parse_hex_bytes(text);
    ASSERT_FALSE(bytes.has_value()) << text;
    EXPECT_THAT(bytes.error().message, HasSubstr(words)) << text;
  }
}

TEST(FrameExplanation, NamesEachByteOfATcpReply) {
  const FrameExplanation found = explain_reply(kTcp);
  EXPECT_EQ(found.framing, Framing::tcp);
  EXPECT_EQ(found.transaction, 1);
  EXPECT_EQ(found.unit, 17);
  EXPECT_EQ(found.function, 3);
  EXPECT_FALSE(found.exception_code.has_value());
  EXPECT_THAT(found.registers, ElementsAre(0x022B, 0x0000, 0x0064));
  EXPECT_EQ(found.registers_begin, 9u);
  EXPECT_THAT(found.problems, IsEmpty());
  ASSERT_THAT(found.parts, SizeIs(6));
  EXPECT_EQ(found.parts[3].begin, 6u);
  EXPECT_EQ(found.parts[3].meaning, "unit 17");
  EXPECT_EQ(found.parts[5].meaning, "6 bytes of registers");
}

TEST(FrameExplanation, TellsASerialFrameByItsCheckSum) {
  const FrameExplanation found = explain_reply(kRtu);
  EXPECT_EQ(found.framing, Framing::rtu);
  EXPECT_EQ(found.unit, 17);
  EXPECT_THAT(found.registers, ElementsAre(0x022B, 0x0000, 0x0064));
  EXPECT_THAT(found.problems, IsEmpty());
  EXPECT_EQ(found.parts.back().begin, kRtu.size() - 2);
}

TEST(FrameExplanation, TakesAnythingElseForRegisters) {
  const FrameExplanation found = explain_reply(bytes_of("0000 0001 86A0"));
  EXPECT_EQ(found.framing, Framing::registers);
  EXPECT_THAT(found.registers, ElementsAre(0, 1, 0x86A0));
  EXPECT_FALSE(found.unit.has_value());
  EXPECT_THAT(found.problems, IsEmpty());
}

TEST(FrameExplanation, ExceptionsHaveWords) {
  const FrameExplanation found = explain_reply(bytes_of("0001 0000 0003 11 83 02"));
  EXPECT_EQ(found.function, 3);
  EXPECT_EQ(found.exception_code, 2);
  EXPECT_EQ(found.parts.back().meaning, "exception 2 (illegal data address)");
  EXPECT_THAT(found.problems, IsEmpty());
}

// Each way of being wrong has one sentence that says which; nothing is taken for good.
TEST(FrameExplanation, EveryDamageIsASentence) {
  const std::pair<const char*, const char*> cases[] = {
      {"0001 0000 0009 11 03 06 022B 0000", "9 bytes follow, and 7 do"},
      {"0001 0000 0009 11 03 06 022B 0000 0064 00", "9 bytes follow, and 10 do"},
      {"0001 0000 0009 11 03 04 022B 0000 0064", "the byte count is 4, and 6 bytes"},
      {"0001 0000 0008 11 03 05 022B 0000 00", "an even number of bytes"},
      {"0001 0000 0003 11 03 00", "the byte count is 0"},
      {"0001 0000 0002 11 83", "ends before the exception code"},
      {"0001 0000 0004 11 83 02 00", "1 bytes follow the exception code"},
      {"0001 0000 0002 11 03", "ends before its byte count"},
      {"0001 0000 0006 11 10 0000 0002", "function 16 is none that recald uses"},
      {"0001 0000 0006 11 03 0000 0002", "asks for 2 registers from address 0"},
      {"11 03 06 022B 0000 0064 0000", "the check sum is 0000"},
      {"11 83 02 0000", "the check sum is 0000"},
      {"0000 0001 86", "half of one"},
  };
  for (const auto& [text, words] : cases) {
    const FrameExplanation found = explain_reply(bytes_of(text));
    ASSERT_THAT(found.problems, ::testing::Not(IsEmpty())) << text;
    EXPECT_THAT(::testing::PrintToString(found.problems), HasSubstr(words)) << text;
  }
}

// truncated_everywhere, flipped: what is shown as good registers is what the checks would take.
TEST(FrameExplanation, CutAnywhereItSaysSoAndNeverReadsBeyond) {
  for (const Bytes* whole : {&kTcp, &kRtu}) {
    for (const Framing as : {Framing::tcp, Framing::rtu, Framing::registers}) {
      for (std::size_t size = 1; size <= whole->size(); ++size) {
        const Bytes cut(whole->begin(), whole->begin() + static_cast<std::ptrdiff_t>(size));
        const FrameExplanation found = explain_reply(cut, as);
        std::size_t explained = 2 * found.registers.size();
        for (const FramePart& part : found.parts) {
          EXPECT_LE(part.begin + part.size, size);
          explained += part.size;
        }
        EXPECT_EQ(explained, size) << "every byte is explained once";
        const bool is_whole =
            size == whole->size() && as == (whole == &kTcp ? Framing::tcp : Framing::rtu);
        if (as != Framing::registers) {
          EXPECT_EQ(found.problems.empty(), is_whole) << size;
        }
      }
    }
  }
}

TEST(FrameExplanation, FramingHasNames) {
  for (const Framing framing : {Framing::tcp, Framing::rtu, Framing::registers}) {
    EXPECT_EQ(*parse_framing(to_string(framing)), framing);
  }
  EXPECT_THAT(parse_framing("ascii").error().message, HasSubstr("tcp, rtu or registers"));
}

TEST(FramedRequest, BothTransports) {
  const auto tcp = parse_request(bytes_of("0007 0000 0006 11 04 006B 0003"));
  ASSERT_TRUE(tcp.has_value()) << tcp.error().message;
  EXPECT_EQ(tcp->framing, Framing::tcp);
  EXPECT_EQ(tcp->transaction, 7);
  EXPECT_EQ(tcp->request, (ReadRequest{17, Function::read_input_registers, 0x6B, 3}));

  const auto rtu = parse_request(bytes_of("01 04 00 00 00 01 31 CA"));
  ASSERT_TRUE(rtu.has_value()) << rtu.error().message;
  EXPECT_EQ(rtu->framing, Framing::rtu);
  EXPECT_EQ(rtu->request, (ReadRequest{1, Function::read_input_registers, 0, 1}));
}

TEST(FramedRequest, EveryOtherIsRefused) {
  const std::pair<const char*, const char*> cases[] = {
      {"01 04 00 00 00 01 31 CB", "check sum is CB31"},
      {"0007 0000 0006 11 06 006B 0003", "function 6"},
      {"0007 0000 0006 11 03 006B 007E", "126 registers from address 107"},
      {"0007 0000 0006 11 03 FFFF 0002", "2 registers from address 65535"},
      {"0007 0000 0006 11 03 0000 0000", "0 registers"},
      {"0007 0001 0006 11 03 006B 0003", "12 on TCP"},
      {"11 03", "these are 2 bytes"},
  };
  for (const auto& [text, words] : cases) {
    const auto request = parse_request(bytes_of(text));
    ASSERT_FALSE(request.has_value()) << text;
    EXPECT_THAT(request.error().message, HasSubstr(words)) << text;
  }
}

}  // namespace
}  // namespace recald::modbus::frame_explanation_test
