// Whatever a client sends: frames are cut where their headers say, however the bytes arrive, and
// only a read of registers that are there is called one.
#include "adapters/modbus/request_frame.hpp"

#include <algorithm>
#include <span>

#include "tests/fuzz/require.hpp"

namespace recald::fuzz {
namespace {

using modbus::CutRequest;
using modbus::RequestVerdict;
using Bytes = std::span<const std::uint8_t>;

void require_right(Bytes frame, std::size_t registers, RequestVerdict verdict) {
  const std::uint8_t function = frame[7];
  const bool is_read_function = function == 3 || function == 4;
  require(is_read_function == (verdict != RequestVerdict::illegal_function),
          "every other function is refused as such");
  if (verdict != RequestVerdict::read) return;
  require(frame.size() == 12, "a read has twelve bytes");
  const unsigned address = static_cast<unsigned>(frame[8] << 8 | frame[9]);
  const unsigned count = static_cast<unsigned>(frame[10] << 8 | frame[11]);
  require(count >= 1 && count <= 125 && address + count <= registers, "a read is on the map");
}

/// More bytes never change what fewer have settled.
void require_settled(Bytes bytes, const CutRequest& whole) {
  for (std::size_t size = 0; size < bytes.size(); ++size) {
    const CutRequest cut = modbus::cut_request(bytes.first(size));
    if (cut.kind == CutRequest::Kind::incomplete) {
      require(size < modbus::kTcpFrameMax, "a full buffer is never incomplete");
      continue;
    }
    require(cut.kind == whole.kind && cut.size == whole.size, "what is settled stays so");
  }
}

}  // namespace
}  // namespace recald::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace recald::fuzz;
  Input input{data, size};
  const std::size_t registers = input.word();
  Bytes left{input.rest(), input.left()};
  for (;;) {
    const CutRequest cut = recald::modbus::cut_request(left);
    require_settled(left.first(std::min(left.size(), recald::modbus::kTcpFrameMax)), cut);
    if (cut.kind != CutRequest::Kind::whole) return 0;
    require(cut.size >= 8 && cut.size <= recald::modbus::kTcpFrameMax && cut.size <= left.size(),
            "a frame lies within its bytes");
    const Bytes frame = left.first(cut.size);
    require_right(frame, registers, recald::modbus::check_request(frame, registers));
    left = left.subspan(cut.size);
  }
}
