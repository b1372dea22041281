#include "simulators/devices/device_frames.hpp"

#include <gmock/gmock.h>

namespace recald::simulators::device_frames_test {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;
using ::testing::SizeIs;

const Bytes kTcp{0x12, 0x34, 0, 0, 0, 6, 7, 3, 0x50, 0x00, 0, 4};
/// Modbus over Serial Line's own example of a read has its check sum low byte first: 0x02 0x07 for
/// unit 2, function 7 (V1.02, 6.2.2: 0x1241 is sent as 41 12).
const Bytes kRtu{0x02, 0x07, 0x41, 0x12};
const Bytes kRtuRead{0x11, 0x03, 0x00, 0x6B, 0x00, 0x03, 0x76, 0x87};

TEST(DeviceFrames, TakesARequestHoweverItIsCut) {
  for (const Transport transport : {Transport::tcp, Transport::rtu}) {
    const Bytes& whole = transport == Transport::tcp ? kTcp : kRtuRead;
    for (std::size_t cut = 0; cut <= whole.size(); ++cut) {
      SCOPED_TRACE(cut);
      Bytes received(whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(cut));
      const auto first = take_requests(transport, received);
      EXPECT_THAT(first.requests, SizeIs(cut == whole.size() ? 1 : 0));
      received.insert(received.end(), whole.begin() + static_cast<std::ptrdiff_t>(cut),
                      whole.end());
      const auto second = take_requests(transport, received);
      EXPECT_EQ(first.requests.size() + second.requests.size(), 1U);
      EXPECT_FALSE(first.is_garbled || second.is_garbled);
      EXPECT_THAT(received, IsEmpty());
    }
  }
}

TEST(DeviceFrames, FieldsStandWhereTheProtocolSays) {
  Bytes received = kTcp;
  const auto tcp = take_requests(Transport::tcp, received).requests.at(0);
  EXPECT_EQ(tcp.transaction, 0x1234);
  EXPECT_EQ(tcp.unit, 7);
  EXPECT_THAT(tcp.pdu, ElementsAre(3, 0x50, 0, 0, 4));
  received = kRtuRead;
  const auto rtu = take_requests(Transport::rtu, received).requests.at(0);
  EXPECT_EQ(rtu.unit, 0x11);
  EXPECT_THAT(rtu.pdu, ElementsAre(3, 0, 0x6B, 0, 3));
  received = kRtu;
  EXPECT_THAT(take_requests(Transport::rtu, received).requests.at(0).pdu, ElementsAre(7));
}

TEST(DeviceFrames, GluedRequestsAreTwo) {
  Bytes received = kTcp;
  received.insert(received.end(), kTcp.begin(), kTcp.end());
  received.push_back(9);
  EXPECT_THAT(take_requests(Transport::tcp, received).requests, SizeIs(2));
  EXPECT_THAT(received, ElementsAre(9));
}

TEST(DeviceFrames, GarbageIsThrownAway) {
  for (const auto& [at, value] : std::vector<std::pair<std::size_t, std::uint8_t>>{
           {2, 1}, {3, 1}, {4, 1}, {5, 1}, {5, 255}}) {
    Bytes received = kTcp;
    received[at] = value;
    const auto taken = take_requests(Transport::tcp, received);
    EXPECT_TRUE(taken.is_garbled) << at;
    EXPECT_THAT(taken.requests, IsEmpty());
    EXPECT_THAT(received, IsEmpty());
  }
  for (std::size_t bit = 0; bit < 8 * kRtuRead.size(); ++bit) {
    if (bit / 8 == 1) continue;  // another function may have another length
    Bytes received = kRtuRead;
    received[bit / 8] ^= static_cast<std::uint8_t>(1U << bit % 8);
    EXPECT_TRUE(take_requests(Transport::rtu, received).is_garbled) << bit;
  }
}

TEST(DeviceFrames, WritesOfEveryLengthAreTaken) {
  const std::vector<Bytes> bodies{{1, 6, 0, 1, 0, 9},
                                  {1, 16, 0, 1, 0, 2, 4, 1, 2, 3, 4},
                                  {1, 22, 0, 4, 0, 0xF2, 0, 0x25},
                                  {1, 23, 0, 3, 0, 6, 0, 14, 0, 1, 2, 0, 255}};
  for (const Bytes& body : bodies) {
    // A reply's frame is closed like a request's.
    Bytes received = reply_frame(Transport::rtu, {}, body[0], Bytes(body.begin() + 1, body.end()));
    const auto taken = take_requests(Transport::rtu, received);
    ASSERT_THAT(taken.requests, SizeIs(1)) << static_cast<int>(body[1]);
    EXPECT_EQ(taken.requests[0].pdu.size(), body.size() - 1);
    EXPECT_THAT(received, IsEmpty());
  }
}

TEST(DeviceFrames, RepliesAreClosed) {
  const DeviceRequest request{0x1234, 7, {3}};
  EXPECT_THAT(reply_frame(Transport::tcp, request, 9, {3, 2, 0xAB, 0xCD}),
              ElementsAre(0x12, 0x34, 0, 0, 0, 5, 9, 3, 2, 0xAB, 0xCD));
  EXPECT_THAT(reply_frame(Transport::rtu, request, 0x11, {3, 0, 0x6B, 0, 3}),
              ::testing::ElementsAreArray(kRtuRead));
}

}  // namespace
}  // namespace recald::simulators::device_frames_test
