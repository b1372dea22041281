#include "adapters/modbus/frame.hpp"

#include <gmock/gmock.h>

#include <string>

namespace recald::modbus::frame_test {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

using Bytes = std::vector<std::uint8_t>;

// The example of the protocol's specification, 6.3: holding registers 107 to 109 (0x6B).
constexpr ReadRequest kThreeRegisters{17, Function::read_holding_registers, 0x6B, 3};
const Bytes kPdu{0x03, 0x06, 0x02, 0x2B, 0x00, 0x00, 0x00, 0x64};
constexpr std::uint16_t kTransaction = 0x1501;

Bytes tcp_frame(const Bytes& pdu) {
  Bytes frame{0x15, 0x01, 0x00, 0x00, 0x00, static_cast<std::uint8_t>(pdu.size() + 1), 17};
  frame.insert(frame.end(), pdu.begin(), pdu.end());
  return frame;
}

Bytes rtu_frame(const Bytes& pdu) {
  Bytes frame{17};
  frame.insert(frame.end(), pdu.begin(), pdu.end());
  const std::uint16_t crc = crc16(frame);
  frame.push_back(static_cast<std::uint8_t>(crc & 0xFF));
  frame.push_back(static_cast<std::uint8_t>(crc >> 8));
  return frame;
}

ReadResult check_tcp(const Bytes& frame) {
  return check_tcp_reply(frame, kThreeRegisters, kTransaction);
}

ReadResult check_rtu(const Bytes& frame) { return check_rtu_reply(frame, kThreeRegisters); }

void expect_mismatch(const ReadResult& result, const std::string& what) {
  ASSERT_FALSE(result.has_value());
  EXPECT_EQ(result.error().fault, ReadFault::mismatch);
  EXPECT_THAT(result.error().what, HasSubstr(what));
}

TEST(ModbusRequest, HasTheBytesOfTheSpecification) {
  EXPECT_THAT(encode_request(kThreeRegisters), ElementsAre(17, 0x03, 0x00, 0x6B, 0x00, 0x03));
  EXPECT_THAT(encode_request({1, Function::read_input_registers, 0x5B14, 125}),
              ElementsAre(1, 0x04, 0x5B, 0x14, 0x00, 125));
}

TEST(ModbusReply, GivesTheRegistersOfTheSpecification) {
  for (const ReadResult& result : {check_tcp(tcp_frame(kPdu)), check_rtu(rtu_frame(kPdu))}) {
    ASSERT_TRUE(result.has_value()) << result.error().what;
    EXPECT_THAT(*result, ElementsAre(0x022B, 0x0000, 0x0064));
  }
}

// Published by makers as the reply of unit 1 with one register of 0xFFFF: 01 04 02 FF FF B8 80.
TEST(ModbusReply, CheckSumIsThatOfAPublishedFrame) {
  const Bytes frame{0x01, 0x04, 0x02, 0xFF, 0xFF, 0xB8, 0x80};
  const auto words = check_rtu_reply(frame, {1, Function::read_input_registers, 0, 1});
  ASSERT_TRUE(words.has_value()) << words.error().what;
  EXPECT_THAT(*words, ElementsAre(0xFFFF));
}

TEST(ModbusReply, WrongUnit) {
  Bytes tcp = tcp_frame(kPdu);
  tcp[6] = 18;
  expect_mismatch(check_tcp(tcp), "unit 18 answered for unit 17");
  Bytes body{18};
  body.insert(body.end(), kPdu.begin(), kPdu.end());
  const std::uint16_t crc = crc16(body);
  body.push_back(static_cast<std::uint8_t>(crc & 0xFF));
  body.push_back(static_cast<std::uint8_t>(crc >> 8));
  expect_mismatch(check_rtu(body), "unit 18 answered for unit 17");
}

TEST(ModbusReply, WrongProtocolId) {
  Bytes frame = tcp_frame(kPdu);
  frame[2] = 0x01;
  expect_mismatch(check_tcp(frame), "protocol 256");
}

TEST(ModbusReply, AnswersAnotherTransaction) {
  Bytes frame = tcp_frame(kPdu);
  frame[1] = 0x00;
  expect_mismatch(check_tcp(frame), "transaction 5376 came for transaction 5377");
}

TEST(ModbusReply, AnswersAnotherFunction) {
  Bytes pdu = kPdu;
  pdu[0] = 0x04;
  expect_mismatch(check_tcp(tcp_frame(pdu)), "function 4 came for function 3");
  expect_mismatch(check_rtu(rtu_frame(pdu)), "function 4 came for function 3");
}

TEST(ModbusReply, ByteCountLies) {
  for (const int count : {0, 2, 4, 5, 7, 8, 253, 255}) {
    SCOPED_TRACE(count);
    Bytes pdu = kPdu;
    pdu[1] = static_cast<std::uint8_t>(count);
    expect_mismatch(check_tcp(tcp_frame(pdu)), "bytes of data");
    expect_mismatch(check_rtu(rtu_frame(pdu)), "bytes of data");
  }
}

TEST(ModbusReply, MoreOrLessDataThanItsByteCount) {
  Bytes more = kPdu;
  more.push_back(0x00);
  Bytes less = kPdu;
  less.pop_back();
  for (const Bytes& pdu : {more, less}) {
    expect_mismatch(check_tcp(tcp_frame(pdu)), "the reply says 6 bytes of data and brings");
    expect_mismatch(check_rtu(rtu_frame(pdu)), "the reply says 6 bytes of data and brings");
  }
}

TEST(ModbusReply, LengthInTheHeaderIsThatOfTheFrame) {
  for (const int length : {0, 3, 8, 10, 40, 65535}) {
    SCOPED_TRACE(length);
    Bytes frame = tcp_frame(kPdu);
    frame[4] = static_cast<std::uint8_t>(length >> 8);
    frame[5] = static_cast<std::uint8_t>(length & 0xFF);
    expect_mismatch(check_tcp(frame), "bytes follow; 9 do");
  }
}

TEST(ModbusReply, TruncatedEverywhere) {
  const Bytes tcp = tcp_frame(kPdu);
  for (std::size_t size = 0; size < tcp.size(); ++size) {
    const auto result = check_tcp(Bytes(tcp.begin(), tcp.begin() + static_cast<long>(size)));
    ASSERT_FALSE(result.has_value()) << size;
    EXPECT_EQ(result.error().fault, ReadFault::mismatch) << size;
  }
  const Bytes rtu = rtu_frame(kPdu);
  for (std::size_t size = 0; size < rtu.size(); ++size) {
    EXPECT_FALSE(check_rtu(Bytes(rtu.begin(), rtu.begin() + static_cast<long>(size)))) << size;
  }
}

// A flipped bit is either seen or lies in the data, where TCP has no check sum of its own.
TEST(ModbusReply, FlippedEverywhere) {
  const Bytes tcp = tcp_frame(kPdu);
  constexpr std::size_t kDataBegins = 9;
  for (std::size_t bit = 0; bit < 8 * tcp.size(); ++bit) {
    Bytes frame = tcp;
    frame[bit / 8] ^= static_cast<std::uint8_t>(1u << bit % 8);
    EXPECT_EQ(check_tcp(frame).has_value(), bit / 8 >= kDataBegins) << bit;
  }
  const Bytes rtu = rtu_frame(kPdu);
  for (std::size_t bit = 0; bit < 8 * rtu.size(); ++bit) {
    Bytes frame = rtu;
    frame[bit / 8] ^= static_cast<std::uint8_t>(1u << bit % 8);
    const auto result = check_rtu(frame);
    ASSERT_FALSE(result.has_value()) << bit;
    EXPECT_EQ(result.error().fault, ReadFault::crc) << bit;
  }
}

TEST(ModbusReply, ExceptionOfEachCode) {
  const std::vector<std::pair<int, std::string>> codes{
      {1, "illegal function"},    {2, "illegal data address"}, {3, "illegal data value"},
      {4, "device failure"},      {5, "still working"},        {6, "busy"},
      {8, "memory parity"},       {10, "gateway path"},        {11, "does not respond"},
      {99, "not in the standard"}};
  for (const auto& [code, words] : codes) {
    SCOPED_TRACE(code);
    const Bytes pdu{0x83, static_cast<std::uint8_t>(code)};
    for (const ReadResult& result : {check_tcp(tcp_frame(pdu)), check_rtu(rtu_frame(pdu))}) {
      ASSERT_FALSE(result.has_value());
      EXPECT_EQ(result.error().fault, ReadFault::exception);
      EXPECT_EQ(result.error().exception_code, code);
      EXPECT_THAT(result.error().what, HasSubstr(words));
    }
  }
}

TEST(ModbusReply, ExceptionOfAnotherLengthOrFunction) {
  expect_mismatch(check_tcp(tcp_frame({0x83})), "an exception of 1 bytes");
  expect_mismatch(check_tcp(tcp_frame({0x83, 2, 0})), "an exception of 3 bytes");
  expect_mismatch(check_tcp(tcp_frame({0x84, 2})), "function 132 came for function 3");
}

}  // namespace
}  // namespace recald::modbus::frame_test
