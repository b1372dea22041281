#include "adapters/modbus/frame.hpp"

#include <fmt/format.h>

#include <cassert>

#include "adapters/modbus/bytes.hpp"

namespace recald::modbus {
namespace {

constexpr std::size_t kHeaderBytes = 7;  // transaction, protocol, length, unit

/// A reply without transport bytes: the function, then byte count and data, or exception code.
ReadResult check_pdu(Bytes pdu, const ReadRequest& request) {
  if (pdu.empty()) return mismatch("the reply ends before its function code");
  const auto asked = static_cast<std::uint8_t>(request.function);
  if (pdu[0] == (asked | kExceptionBit)) {
    if (pdu.size() != 2) {
      return mismatch(fmt::format("an exception of {} bytes, which has 2", pdu.size()));
    }
    return tl::unexpected(
        ReadFailure{ReadFault::exception, pdu[1],
                    fmt::format("the unit answers exception {}", describe_exception(pdu[1]))});
  }
  if (pdu[0] != asked) {
    return mismatch(fmt::format("a reply to function {} came for function {}", pdu[0], asked));
  }
  const std::size_t data_bytes = 2u * request.count;
  if (pdu.size() < 2) return mismatch("the reply ends before its byte count");
  if (pdu[1] != data_bytes) {
    return mismatch(fmt::format("the reply says {} bytes of data; {} registers have {}", pdu[1],
                                request.count, data_bytes));
  }
  if (pdu.size() != 2 + data_bytes) {
    return mismatch(
        fmt::format("the reply says {} bytes of data and brings {}", data_bytes, pdu.size() - 2));
  }
  Words words(request.count);
  for (std::size_t i = 0; i < words.size(); ++i) {
    words[i] = static_cast<std::uint16_t>(word_at(pdu, 2 + 2 * i));
  }
  return words;
}

}  // namespace

tl::unexpected<ReadFailure> mismatch(std::string what) {
  return tl::unexpected(ReadFailure{ReadFault::mismatch, 0, std::move(what)});
}

std::array<std::uint8_t, 6> encode_request(const ReadRequest& request) {
  assert(request.count >= 1 && request.count <= kRegistersMax);
  assert(request.address + request.count <= 0x10000);
  const auto high = [](std::uint16_t word) { return static_cast<std::uint8_t>(word >> 8); };
  const auto low = [](std::uint16_t word) { return static_cast<std::uint8_t>(word & 0xFF); };
  return {request.unit,          static_cast<std::uint8_t>(request.function),
          high(request.address), low(request.address),
          high(request.count),   low(request.count)};
}

ReadResult check_tcp_reply(Bytes frame, const ReadRequest& request, std::uint16_t transaction) {
  if (frame.size() < kHeaderBytes) {
    return mismatch(fmt::format("a frame of {} bytes, less than its header", frame.size()));
  }
  if (word_at(frame, 0) != transaction) {
    return mismatch(fmt::format("a reply to transaction {} came for transaction {}",
                                word_at(frame, 0), transaction));
  }
  if (word_at(frame, 2) != 0) {
    return mismatch(fmt::format("protocol {} in the header; Modbus is 0", word_at(frame, 2)));
  }
  // The length field counts the bytes after it: the unit and the PDU.
  if (word_at(frame, 4) != frame.size() - (kHeaderBytes - 1)) {
    return mismatch(fmt::format("the header says {} bytes follow; {} do", word_at(frame, 4),
                                frame.size() - (kHeaderBytes - 1)));
  }
  if (frame[6] != request.unit) {
    return mismatch(fmt::format("unit {} answered for unit {}", frame[6], request.unit));
  }
  return check_pdu(frame.subspan(kHeaderBytes), request);
}

ReadResult check_rtu_reply(Bytes frame, const ReadRequest& request) {
  if (frame.size() < 4) {
    return mismatch(fmt::format("a frame of {} bytes; the shortest has 4", frame.size()));
  }
  const Bytes body = frame.first(frame.size() - 2);
  const unsigned stated = static_cast<unsigned>(frame[body.size() + 1]) << 8 | frame[body.size()];
  if (const unsigned computed = crc16(body); computed != stated) {
    return tl::unexpected(ReadFailure{
        ReadFault::crc, 0,
        fmt::format("the frame's check sum is {:04X}; its bytes give {:04X}", stated, computed)});
  }
  if (body[0] != request.unit) {
    return mismatch(fmt::format("unit {} answered for unit {}", body[0], request.unit));
  }
  return check_pdu(body.subspan(1), request);
}

std::uint16_t crc16(Bytes bytes) {
  unsigned crc = 0xFFFF;
  for (const std::uint8_t byte : bytes) {
    crc ^= byte;
    for (int bit = 0; bit < 8; ++bit) crc = (crc & 1u) != 0 ? (crc >> 1) ^ 0xA001u : crc >> 1;
  }
  return static_cast<std::uint16_t>(crc);
}

std::string describe_exception(std::uint8_t code) {
  const auto meaning = [&]() -> std::string_view {
    switch (code) {
      case 0x01:
        return "illegal function";
      case 0x02:
        return "illegal data address";
      case 0x03:
        return "illegal data value";
      case 0x04:
        return "device failure";
      case 0x05:
        return "acknowledged, still working";
      case 0x06:
        return "device busy";
      case 0x08:
        return "memory parity error";
      case 0x0A:
        return "gateway path unavailable";
      case 0x0B:
        return "gateway: the device does not respond";
      default:
        return "not in the standard";
    }
  };
  return fmt::format("{} ({})", code, meaning());
}

bool is_busy(std::uint8_t exception) { return exception == 0x05 || exception == 0x06; }

bool is_from_gateway(std::uint8_t exception) { return exception == 0x0A || exception == 0x0B; }

bool is_illegal_span(const ReadFailure& failure) {
  return failure.fault == ReadFault::exception &&
         (failure.exception_code == 0x02 || failure.exception_code == 0x03);
}

bool is_refusal(const ReadFailure& failure) {
  return failure.fault == ReadFault::exception && !is_busy(failure.exception_code) &&
         !is_from_gateway(failure.exception_code);
}

}  // namespace recald::modbus
