#include "adapters/modbus/request_frame.hpp"

#include "adapters/modbus/bytes.hpp"
#include "adapters/ports/register_read.hpp"

namespace recald::modbus {
namespace {

constexpr std::size_t kBeforeLengthEnds = 6;  // transaction, protocol, length
constexpr std::size_t kFunctionAt = 7;        // after the unit
constexpr std::size_t kReadBytes = 12;        // header, function, address, count
constexpr unsigned kFollowMin = 2;            // unit and function
constexpr unsigned kFollowMax = 254;

}  // namespace

CutRequest cut_request(std::span<const std::uint8_t> bytes) {
  using Kind = CutRequest::Kind;
  if (bytes.size() >= 4 && word_at(bytes, 2) != 0) return {Kind::malformed};
  if (bytes.size() < kBeforeLengthEnds) return {Kind::incomplete};
  const unsigned follow = word_at(bytes, 4);
  if (follow < kFollowMin || follow > kFollowMax) return {Kind::malformed};
  // An exception to function 0, or to one above 127, could not be told from another function's.
  if (bytes.size() > kFunctionAt && (bytes[kFunctionAt] == 0 || bytes[kFunctionAt] > 127)) {
    return {Kind::malformed};
  }
  const std::size_t size = kBeforeLengthEnds + follow;
  if (bytes.size() < size) return {Kind::incomplete};
  return {Kind::whole, size};
}

RequestVerdict check_request(std::span<const std::uint8_t> frame, std::size_t registers) {
  const std::uint8_t function = frame[kFunctionAt];
  if (function != static_cast<std::uint8_t>(Function::read_holding_registers) &&
      function != static_cast<std::uint8_t>(Function::read_input_registers)) {
    return RequestVerdict::illegal_function;
  }
  if (frame.size() != kReadBytes) return RequestVerdict::illegal_value;
  const unsigned address = word_at(frame, 8);
  const unsigned count = word_at(frame, 10);
  if (count < 1 || count > kRegistersMax) return RequestVerdict::illegal_value;
  return address + count <= registers ? RequestVerdict::read : RequestVerdict::illegal_address;
}

}  // namespace recald::modbus
