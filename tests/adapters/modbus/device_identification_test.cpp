/// Read device identification: the specification's example, several parts, damage.
#include "adapters/modbus/device_identification.hpp"

#include <gmock/gmock.h>

#include "adapters/modbus/connection.hpp"
#include "tests/support/scripted_device.hpp"

namespace recald::modbus::device_identification_test {
namespace {

using recald::testing::Bytes;
using recald::testing::Piece;
using recald::testing::ScriptedLine;
using recald::testing::ScriptedServer;
using ::testing::ElementsAre;
using ::testing::Pair;

/// A reply with some objects; `next` not 0: more follow.
Bytes reply(const std::vector<std::pair<std::uint8_t, std::string>>& objects,
            std::uint8_t next = 0) {
  const auto more = static_cast<std::uint8_t>(next == 0 ? 0 : 0xFF);
  Bytes pdu{0x2B, 0x0E, 1, 1, more, next, static_cast<std::uint8_t>(objects.size())};
  for (const auto& [id, text] : objects) {
    pdu.push_back(id);
    pdu.push_back(static_cast<std::uint8_t>(text.size()));
    pdu.insert(pdu.end(), text.begin(), text.end());
  }
  return pdu;
}

Bytes on_tcp(const Bytes& pdu, std::uint8_t unit = 5) {
  Bytes frame{0, 0, 0, 0, 0, static_cast<std::uint8_t>(pdu.size() + 1), unit};
  frame.insert(frame.end(), pdu.begin(), pdu.end());
  return frame;
}

TEST(DeviceIdentification, AsksForTheBasicObjectsAndNothingElse) {
  EXPECT_THAT(encode_identity_request(5, 0), ElementsAre(5, 0x2B, 0x0E, 1, 0));
}

TEST(DeviceIdentification, ReadsTheObjectsOfAReply) {
  const auto part = parse_identity_reply(reply({{0, "Company"}, {1, "Product"}, {2, "V2.11"}}));
  ASSERT_TRUE(part.has_value()) << part.error().what;
  EXPECT_THAT(part->objects, ElementsAre(Pair(0, "Company"), Pair(1, "Product"), Pair(2, "V2.11")));
  EXPECT_EQ(part->next_object, 0);
  EXPECT_EQ(parse_identity_reply(reply({{0, "x"}}, 1))->next_object, 1);
}

TEST(DeviceIdentification, CutAnywhereItIsRefused) {
  const Bytes whole = reply({{0, "Company"}, {1, ""}, {2, "V2.11"}});
  for (std::size_t size = 0; size < whole.size(); ++size) {
    const Bytes cut(whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(size));
    EXPECT_FALSE(parse_identity_reply(cut).has_value()) << size;
  }
  Bytes longer = whole;
  longer.push_back(0);
  EXPECT_FALSE(parse_identity_reply(longer).has_value());
  EXPECT_EQ(parse_identity_reply(Bytes{0xAB, 1}).error().exception_code, 1);
}

TEST(DeviceIdentification, ComesInPartsOverTcp) {
  ScriptedServer device{[](const Bytes& request, int) -> std::vector<Piece> {
    if (request[10] == 0) {
      const Bytes first = on_tcp(reply({{0, "Company"}}, 1));
      return {{{}, {first.begin(), first.begin() + 9}}, {{}, {first.begin() + 9, first.end()}}};
    }
    return {{{}, on_tcp(reply({{1, "Product"}, {2, "V1"}}))}};
  }};
  Connection connection{TcpEndpoint{.host = "127.0.0.1", .port = device.port()}};
  const auto identity = connection.identify(5, std::chrono::seconds{5});
  ASSERT_TRUE(identity.has_value()) << identity.error().what;
  EXPECT_EQ(*identity, (DeviceIdentity{"Company", "Product", "V1"}));
  EXPECT_EQ(device.requests(), 2);
}

TEST(DeviceIdentification, ComesOverASerialLineWithItsCheckSum) {
  for (const bool is_good : {true, false}) {
    ScriptedLine device{[&](const Bytes& request, int) -> std::vector<Piece> {
      Bytes frame{request[0]};
      const Bytes pdu = reply({{0, "Company"}, {1, "Product"}, {2, "V1"}});
      frame.insert(frame.end(), pdu.begin(), pdu.end());
      const std::uint16_t sum = crc16(frame);
      frame.push_back(static_cast<std::uint8_t>(sum & 0xFF));
      frame.push_back(static_cast<std::uint8_t>((sum >> 8) ^ (is_good ? 0 : 1)));
      return {{{}, frame}};
    }};
    Connection connection{SerialPort{.device = device.device(), .baud = 115'200}};
    const auto identity = connection.identify(5, std::chrono::milliseconds{is_good ? 5'000 : 300});
    EXPECT_EQ(identity.has_value(), is_good);
  }
}

TEST(DeviceIdentification, RefusalsAndOthersAnswersAreTold) {
  const std::pair<Bytes, ReadFault> cases[] = {
      {on_tcp({0xAB, 1}), ReadFault::exception},
      {on_tcp(reply({{0, "Company"}}), 6), ReadFault::mismatch},
      {on_tcp({3, 2, 0, 1}), ReadFault::mismatch},
      {{}, ReadFault::closed},
  };
  for (const auto& [frame, fault] : cases) {
    ScriptedServer device{[&](const Bytes&, int) { return std::vector<Piece>{{{}, frame}}; }};
    Connection connection{TcpEndpoint{.host = "127.0.0.1", .port = device.port()}};
    const auto identity = connection.identify(5, std::chrono::seconds{5});
    ASSERT_FALSE(identity.has_value());
    EXPECT_EQ(identity.error().fault, fault) << identity.error().what;
    EXPECT_EQ(connection.is_open(), fault == ReadFault::exception);
  }
}

TEST(DeviceIdentification, ADeviceThatAlwaysHasMoreIsLeft) {
  ScriptedServer device{[](const Bytes&, int) {
    return std::vector<Piece>{{{}, on_tcp(reply({{0, "Company"}}, 1))}};
  }};
  Connection connection{TcpEndpoint{.host = "127.0.0.1", .port = device.port()}};
  EXPECT_EQ(connection.identify(5, std::chrono::seconds{5})->vendor, "Company");
  EXPECT_EQ(device.requests(), 4);
}

}  // namespace
}  // namespace recald::modbus::device_identification_test
