// A reply is taken only when its bytes are those that its words and request make; whatever else
// comes is refused with a sentence.
#include <vector>

#include "adapters/modbus/frame.hpp"
#include "tests/fuzz/require.hpp"

namespace recald::fuzz {
namespace {

using modbus::Function;
using modbus::ReadFault;
using modbus::ReadRequest;
using modbus::ReadResult;
using modbus::Words;
using Bytes = std::vector<std::uint8_t>;

void append_word(Bytes& bytes, unsigned word) {
  bytes.push_back(static_cast<std::uint8_t>(word >> 8));
  bytes.push_back(static_cast<std::uint8_t>(word & 0xFF));
}

/// Unit and PDU of the one right answer.
Bytes answer(const ReadRequest& request, const Words& words) {
  Bytes bytes{request.unit, static_cast<std::uint8_t>(request.function),
              static_cast<std::uint8_t>(2 * words.size())};
  for (const std::uint16_t word : words) append_word(bytes, word);
  return bytes;
}

Bytes refusal(const ReadRequest& request, std::uint8_t code) {
  const auto function = static_cast<std::uint8_t>(request.function);
  return {request.unit, static_cast<std::uint8_t>(function | 0x80), code};
}

Bytes as_tcp(std::uint16_t transaction, const Bytes& body) {
  Bytes frame;
  append_word(frame, transaction);
  append_word(frame, 0);
  append_word(frame, static_cast<unsigned>(body.size()));
  frame.insert(frame.end(), body.begin(), body.end());
  return frame;
}

Bytes as_rtu(Bytes body) {
  const std::uint16_t crc = modbus::crc16(body);
  body.push_back(static_cast<std::uint8_t>(crc & 0xFF));
  body.push_back(static_cast<std::uint8_t>(crc >> 8));
  return body;
}

/// `as_frame` puts the transport's bytes around the body that a result stands for.
template <class AsFrame>
void require_faithful(const Bytes& frame, const ReadRequest& request, const ReadResult& result,
                      AsFrame as_frame) {
  if (result) {
    require(result->size() == request.count, "as many words as were asked for");
    require(as_frame(answer(request, *result)) == frame, "words that are not the frame's");
    return;
  }
  require_sentence(result.error().what);
  if (result.error().fault != ReadFault::exception) return;
  require(as_frame(refusal(request, result.error().exception_code)) == frame,
          "an exception that is not the frame's");
}

/// The whole is an answer, and no part of it is.
template <class Check>
void require_whole(Bytes frame, unsigned cut, Check check) {
  require(check(frame).has_value(), "a right answer is taken");
  frame.resize(cut % frame.size());
  require(!check(frame).has_value(), "a cut answer is refused");
}

}  // namespace
}  // namespace recald::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace recald::fuzz;
  Input input{data, size};
  ReadRequest request{};
  request.unit = input.byte();
  request.function =
      input.below(2) == 0 ? Function::read_holding_registers : Function::read_input_registers;
  request.address = input.word();
  request.count = static_cast<std::uint16_t>(1 + input.below(recald::modbus::kRegistersMax));
  const std::uint16_t transaction = input.word();
  const bool computes_crc = input.below(2) == 1;  // else a right one is found once in 65 536 times
  Bytes frame(input.rest(), input.rest() + input.left());

  const auto check_tcp = [&](const Bytes& bytes) {
    return check_tcp_reply(bytes, request, transaction);
  };
  const auto check_rtu = [&](const Bytes& bytes) { return check_rtu_reply(bytes, request); };
  require_faithful(frame, request, check_tcp(frame),
                   [&](const Bytes& body) { return as_tcp(transaction, body); });
  if (computes_crc) frame = as_rtu(frame);
  require_faithful(frame, request, check_rtu(frame), as_rtu);

  const unsigned cut = input.word();
  Words words(request.count);
  for (std::uint16_t& word : words) word = input.word();
  require_whole(as_tcp(transaction, answer(request, words)), cut, check_tcp);
  require_whole(as_rtu(answer(request, words)), cut, check_rtu);
  return 0;
}
