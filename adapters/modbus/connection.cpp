#include "adapters/modbus/connection.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <modbus/modbus.h>
#include <poll.h>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <random>
#include <thread>

#include "core/result.hpp"

namespace recald::modbus {
namespace {

using std::chrono::microseconds;
using std::chrono::steady_clock;

/// libmodbus calls select on its sockets, and FD_SET beyond 1024 is undefined. The rest of the
/// process needs descriptors too.
constexpr int kDescriptorMax = 900;
constexpr milliseconds kSilenceAfterTimeout{50};

/// The number that the next descriptor would get.
int next_descriptor() {
  const int descriptor = ::open("/dev/null", O_RDONLY | O_CLOEXEC);
  if (descriptor >= 0) ::close(descriptor);
  return descriptor;
}

std::string words_of(int error) { return modbus_strerror(error); }

tl::unexpected<ReadFailure> failed(ReadFault fault, std::string what) {
  return tl::unexpected(ReadFailure{fault, 0, std::move(what)});
}

void set_timeout(modbus_t* context, milliseconds timeout) {
  const auto seconds = std::chrono::duration_cast<std::chrono::seconds>(timeout);
  const microseconds rest = timeout - seconds;
  modbus_set_response_timeout(context, static_cast<std::uint32_t>(seconds.count()),
                              static_cast<std::uint32_t>(rest.count()));
}

/// The PDU of a reply to any function, or empty while bytes are missing.
tl::expected<std::vector<std::uint8_t>, ReadFailure> whole_pdu(
    const std::vector<std::uint8_t>& frame, std::uint8_t unit, bool is_rtu) {
  constexpr std::size_t kHeader = 7;
  // A serial frame does not state its length: it is complete when its checksum fits.
  const std::size_t head = is_rtu ? 1 : kHeader;
  const std::size_t tail = is_rtu ? 2 : 0;
  if (frame.size() < head + 2 + tail) return {};
  if (is_rtu) {
    const std::span<const std::uint8_t> body{frame.data(), frame.size() - tail};
    const unsigned stated = static_cast<unsigned>(frame.back()) << 8 | frame[frame.size() - 2];
    if (crc16(body) != stated) return {};
  } else {
    const std::size_t length = static_cast<std::size_t>(frame[4] << 8 | frame[5]);
    if (frame.size() < length + kHeader - 1) return {};
    if (frame[2] != 0 || frame[3] != 0 || frame.size() != length + kHeader - 1) {
      return failed(ReadFault::mismatch, "the frame's header contradicts its bytes");
    }
  }
  if (frame[head - 1] != unit) {
    return failed(ReadFault::mismatch,
                  fmt::format("unit {} answered for unit {}", frame[head - 1], unit));
  }
  return std::vector<std::uint8_t>(frame.begin() + static_cast<std::ptrdiff_t>(head),
                                   frame.end() - static_cast<std::ptrdiff_t>(tail));
}

/// The line is idle, so a dozen bytes fit into its buffer.
bool send_whole(int descriptor, const std::vector<std::uint8_t>& frame) {
  const auto sent = ::send(descriptor, frame.data(), frame.size(), MSG_NOSIGNAL);
  return sent == static_cast<ssize_t>(frame.size());
}

/// Appends what arrives before the deadline. @return what ended it, or nothing
std::optional<ReadFailure> read_more(int descriptor, steady_clock::time_point deadline,
                                     std::vector<std::uint8_t>& frame) {
  const auto left = std::chrono::ceil<milliseconds>(deadline - steady_clock::now());
  pollfd waiting{descriptor, POLLIN, 0};
  if (left <= milliseconds{0} || ::poll(&waiting, 1, static_cast<int>(left.count())) <= 0) {
    return ReadFailure{ReadFault::timeout, 0, "no complete reply before the deadline"};
  }
  std::array<std::uint8_t, MODBUS_MAX_ADU_LENGTH> bytes{};
  const auto received = ::read(descriptor, bytes.data(), bytes.size());
  if (received <= 0) return ReadFailure{ReadFault::closed, 0, "connection lost"};
  frame.insert(frame.end(), bytes.begin(), bytes.begin() + received);
  if (frame.size() <= MODBUS_MAX_ADU_LENGTH) return {};
  return ReadFailure{ReadFault::mismatch, 0, "a reply longer than any frame may be"};
}

int unread_bytes(int descriptor) {
  int bytes = 0;
  return ::ioctl(descriptor, FIONREAD, &bytes) == 0 ? bytes : 0;
}

}  // namespace

struct Connection::Context {
  modbus_t* modbus = nullptr;
  ~Context() {
    if (modbus == nullptr) return;
    modbus_close(modbus);
    modbus_free(modbus);
  }
};

std::string to_string(const Endpoint& endpoint) {
  if (const auto* tcp = std::get_if<TcpEndpoint>(&endpoint)) {
    return fmt::format("{}:{}", tcp->host, tcp->port);
  }
  return std::get<SerialPort>(endpoint).device;
}

microseconds line_time(const SerialPort& port, int characters) {
  const int bits = 1 + port.data_bits + (port.parity == Parity::none ? 0 : 1) + port.stop_bits;
  return microseconds{static_cast<std::int64_t>(characters) * bits * 1'000'000 / port.baud};
}

// From anywhere, so that what was on its way to an earlier process is not taken for an answer to
// this one.
Connection::Connection(Endpoint endpoint)
    : endpoint_(std::move(endpoint)),
      transaction_(static_cast<std::uint16_t>(std::random_device{}())) {}
Connection::~Connection() = default;

bool Connection::has_rtu_frames() const {
  const auto* const tcp = std::get_if<TcpEndpoint>(&endpoint_);
  return tcp == nullptr || tcp->has_rtu_frames;
}

bool Connection::is_open() const { return context_ != nullptr; }

void Connection::close() { context_.reset(); }

std::optional<ReadFailure> Connection::connect() {
  const std::string where = to_string(endpoint_);
  if (next_descriptor() < 0 || next_descriptor() >= kDescriptorMax) {
    return ReadFailure{ReadFault::refused, 0,
                       fmt::format("{}: more than {} files and sockets are open in this process; "
                                   "spread the buses over several gateways",
                                   where, kDescriptorMax)};
  }
  auto context = std::make_unique<Context>();
  if (const auto* tcp = std::get_if<TcpEndpoint>(&endpoint_)) {
    context->modbus = modbus_new_tcp_pi(tcp->host.c_str(), std::to_string(tcp->port).c_str());
  } else {
    const auto& serial = std::get<SerialPort>(endpoint_);
    context->modbus =
        modbus_new_rtu(serial.device.c_str(), serial.baud, static_cast<char>(serial.parity),
                       serial.data_bits, serial.stop_bits);
  }
  if (context->modbus == nullptr) {
    return ReadFailure{ReadFault::refused, 0, fmt::format("{}: {}", where, words_of(errno))};
  }
  if (const auto* tcp = std::get_if<TcpEndpoint>(&endpoint_)) {
    set_timeout(context->modbus, tcp->connect_timeout);  // libmodbus connects within it
  }
  if (modbus_connect(context->modbus) != 0) {
    const int error = errno;
    modbus_free(std::exchange(context->modbus, nullptr));  // nothing is open yet
    return ReadFailure{ReadFault::refused, 0,
                       fmt::format("{}: no connection ({})", where, words_of(error))};
  }
  // This makes the response timeout a deadline for the whole reply.
  modbus_set_byte_timeout(context->modbus, 0, 0);
  context_ = std::move(context);
  if (const auto* tcp = std::get_if<TcpEndpoint>(&endpoint_)) {
    std::this_thread::sleep_for(tcp->connect_delay);
  }
  return {};
}

/// Frames on a serial line are at least 3.5 characters apart.
void Connection::wait_for_silence() {
  if (!is_serial()) return;
  std::this_thread::sleep_until(line_free_);
  // Bytes already in the buffer do not belong to this request.
  modbus_flush(context_->modbus);
}

/// Discards incoming bytes until the line has been silent for a while.
void Connection::drain() {
  const auto& port = std::get<SerialPort>(endpoint_);
  const microseconds silence =
      std::max<microseconds>(line_time(port, 4), microseconds{kSilenceAfterTimeout});
  // A line that never falls silent is noise; the next request will report it.
  for (int rounds = 0; rounds < 20; ++rounds) {
    std::this_thread::sleep_for(silence);
    if (unread_bytes(modbus_get_socket(context_->modbus)) == 0) break;
    modbus_flush(context_->modbus);
  }
}

/// The raw interface of libmodbus gives every request transaction 0, so over TCP we send the frame.
bool Connection::send(std::span<const std::uint8_t> request) {
  if (is_serial()) {
    return modbus_send_raw_request(context_->modbus, request.data(),
                                   static_cast<int>(request.size())) >= 0;
  }
  if (has_rtu_frames()) {
    std::vector<std::uint8_t> frame{request.begin(), request.end()};
    const std::uint16_t sum = crc16(frame);
    frame.push_back(static_cast<std::uint8_t>(sum & 0xFFU));
    frame.push_back(static_cast<std::uint8_t>(sum >> 8U));
    return send_whole(modbus_get_socket(context_->modbus), frame);
  }
  if (++transaction_ == 0) ++transaction_;
  const auto high = [](std::size_t word) { return static_cast<std::uint8_t>(word >> 8U); };
  const auto low = [](std::size_t word) { return static_cast<std::uint8_t>(word & 0xFFU); };
  std::vector<std::uint8_t> frame{high(transaction_),   low(transaction_),  0, 0,
                                  high(request.size()), low(request.size())};
  frame.insert(frame.end(), request.begin(), request.end());
  return send_whole(modbus_get_socket(context_->modbus), frame);
}

bool Connection::answers(std::span<const std::uint8_t> frame) {
  const auto number = static_cast<std::uint16_t>(frame[0] << 8U | frame[1]);
  if (number == transaction_) return echoes_ = true;
  return number == 0 && !echoes_;
}

/// libmodbus speaks RTU on serial ports only. The request says how long the reply is.
ReadResult Connection::receive_rtu(const ReadRequest& request, milliseconds timeout) {
  constexpr std::size_t kExceptionBytes = 5;  // unit, function, code, check sum
  const std::size_t whole = kExceptionBytes + 2u * request.count;
  const int descriptor = modbus_get_socket(context_->modbus);
  const auto deadline = steady_clock::now() + timeout;
  std::vector<std::uint8_t> frame;
  const auto is_whole = [&] {
    const bool is_exception = frame.size() >= 2 && (frame[1] & 0x80U) != 0;
    return frame.size() >= (is_exception ? kExceptionBytes : whole);
  };
  while (!is_whole()) {
    if (auto failure = read_more(descriptor, deadline, frame)) {
      return tl::unexpected(std::move(*failure));
    }
  }
  return check_rtu_reply(frame, request);
}

ReadResult Connection::receive(const ReadRequest& request, milliseconds timeout) {
  std::array<std::uint8_t, MODBUS_MAX_ADU_LENGTH> frame{};
  const auto deadline = steady_clock::now() + timeout;
  for (;;) {
    const int received = modbus_receive_confirmation(context_->modbus, frame.data());
    if (received < 0) {
      switch (errno) {
        case ETIMEDOUT:
          return failed(ReadFault::timeout, "no complete reply before the deadline");
        case EMBBADCRC:
          return failed(ReadFault::crc, "the frame's check sum does not fit its bytes");
        case EMBBADDATA:
        case EMBMDATA:
          return failed(ReadFault::mismatch, "a reply longer than any frame may be");
        default:
          return failed(ReadFault::closed, fmt::format("connection lost ({})", words_of(errno)));
      }
    }
    // On a serial line libmodbus returns 0 for a frame of another unit.
    if (received == 0) return failed(ReadFault::mismatch, "another unit answered");
    const std::span<const std::uint8_t> bytes{frame.data(), static_cast<std::size_t>(received)};
    if (!is_serial() && bytes.size() > 2 && !answers(bytes)) {
      // Late: of a request that was given up. Ours may follow.
      const auto left = std::chrono::floor<milliseconds>(deadline - steady_clock::now());
      if (left <= milliseconds{0}) {
        return failed(ReadFault::timeout, "only the replies to earlier requests came");
      }
      set_timeout(context_->modbus, left);
      continue;
    }
    if (unread_bytes(modbus_get_socket(context_->modbus)) != 0) {
      return failed(ReadFault::mismatch, "more bytes than one reply came");
    }
    const auto number = static_cast<std::uint16_t>(frame[0] << 8U | frame[1]);
    return is_serial() ? check_rtu_reply(bytes, request) : check_tcp_reply(bytes, request, number);
  }
}

ReadResult Connection::exchange(const ReadRequest& request, milliseconds timeout) {
  wait_for_silence();
  modbus_set_slave(context_->modbus, request.unit);
  set_timeout(context_->modbus, timeout);
  const auto bytes = encode_request(request);
  if (!send(bytes)) {
    return failed(ReadFault::closed, fmt::format("connection lost ({})", words_of(errno)));
  }
  const bool is_rtu_over_tcp = has_rtu_frames() && !is_serial();
  ReadResult result = is_rtu_over_tcp ? receive_rtu(request, timeout) : receive(request, timeout);
  if (const auto* serial = std::get_if<SerialPort>(&endpoint_)) {
    line_free_ = steady_clock::now() + line_time(*serial, 7) / 2;
  }
  return result;
}

void Connection::recover_from(const ReadFailure& failure, const ReadRequest& request) {
  if (failure.fault == ReadFault::exception) return;
  // A serial server may pass a late reply on to the next connection.
  const bool may_come_late = has_rtu_frames() && failure.fault == ReadFault::timeout;
  if (may_come_late) timed_out_ = request;
  if (!is_serial() || failure.fault == ReadFault::closed) {
    close();
    return;
  }
  drain();
}

ReadResult Connection::read(const ReadRequest& request, milliseconds timeout) {
  // Unsolicited bytes would be taken for the reply.
  if (is_open() && !is_serial() && unread_bytes(modbus_get_socket(context_->modbus)) != 0) close();
  const bool was_open = is_open();
  if (!was_open) {
    if (auto refusal = connect()) return tl::unexpected(std::move(*refusal));
  }
  ReadResult result = ask(request, timeout);
  // Many devices close an idle connection, which shows only when it is used again.
  const bool was_stale = !result && was_open && result.error().fault == ReadFault::closed;
  return was_stale ? read(request, timeout) : result;
}

/// libmodbus does not know the length of such a reply, so we read its bytes from the descriptor.
tl::expected<std::vector<std::uint8_t>, ReadFailure> Connection::receive_pdu(std::uint8_t unit,
                                                                             milliseconds timeout) {
  const int descriptor = modbus_get_socket(context_->modbus);
  const auto deadline = steady_clock::now() + timeout;
  std::vector<std::uint8_t> frame;
  for (;;) {
    const auto whole = TRY(whole_pdu(frame, unit, has_rtu_frames()));
    if (!whole.empty() && (has_rtu_frames() || answers(frame))) return whole;
    if (!whole.empty()) frame.clear();  // late, of another request
    if (auto failure = read_more(descriptor, deadline, frame)) {
      return tl::unexpected(std::move(*failure));
    }
  }
}

tl::expected<IdentityPart, ReadFailure> Connection::identify_from(std::uint8_t unit,
                                                                  std::uint8_t first_object,
                                                                  milliseconds timeout) {
  if (!is_open()) {
    if (auto refusal = connect()) return tl::unexpected(std::move(*refusal));
  }
  wait_for_silence();
  modbus_set_slave(context_->modbus, unit);
  const auto bytes = encode_identity_request(unit, first_object);
  if (!send(bytes)) {
    return failed(ReadFault::closed, fmt::format("connection lost ({})", words_of(errno)));
  }
  const auto pdu = receive_pdu(unit, timeout);
  if (const auto* serial = std::get_if<SerialPort>(&endpoint_)) {
    line_free_ = steady_clock::now() + line_time(*serial, 7) / 2;
  }
  if (!pdu) return tl::unexpected(pdu.error());
  return parse_identity_reply(*pdu);
}

IdentityResult Connection::identify(std::uint8_t unit, milliseconds timeout) {
  constexpr int kPartsMax = 4;  // three objects; do not follow a device that always says "more"
  std::map<std::uint8_t, std::string> objects;
  std::uint8_t next = 0;
  for (int parts = 0; parts < kPartsMax; ++parts) {
    const auto part = identify_from(unit, next, timeout);
    if (!part) {
      if (is_open()) recover_from(part.error(), {});
      timed_out_.reset();  // a late reply to this is not the reply to a read
      return tl::unexpected(part.error());
    }
    objects.insert(part->objects.begin(), part->objects.end());
    next = part->next_object;
    if (next == 0) break;
  }
  return DeviceIdentity{objects[0], objects[1], objects[2]};
}

ReadResult Connection::ask(const ReadRequest& request, milliseconds timeout) {
  // A serial frame names neither the address nor its request, so a late reply to another request of
  // the same length would be accepted. Asking for one more register tells them apart.
  const std::optional<ReadRequest> before = std::exchange(timed_out_, std::nullopt);
  const bool could_be_swapped = before && before->unit == request.unit &&
                                before->count == request.count && *before != request;
  const bool may_ask_more =
      request.count < kRegistersMax && request.address + request.count < 0x10000;
  if (could_be_swapped && may_ask_more) {
    ReadRequest longer = request;
    ++longer.count;
    ReadResult result = exchange(longer, timeout);
    if (result) {
      result->pop_back();
      return result;
    }
    recover_from(result.error(), longer);
    // An exception came in time for this request: no such register, but the line is clear.
    if (result.error().fault != ReadFault::exception) return result;
  }
  ReadResult result = exchange(request, timeout);
  if (!result) recover_from(result.error(), request);
  return result;
}

}  // namespace recald::modbus
