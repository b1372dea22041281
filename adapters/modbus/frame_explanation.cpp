#include "adapters/modbus/frame_explanation.hpp"

#include <fmt/format.h>

#include <array>
#include <cctype>

#include "adapters/modbus/bytes.hpp"

namespace recald::modbus {
namespace {

constexpr std::size_t kTcpHeader = 7;  // transaction, protocol, length, unit
constexpr std::size_t kRtuShortest = 5;
constexpr std::size_t kCheckSum = 2;
constexpr std::array<std::string_view, 3> kFramings{"tcp", "rtu", "registers"};

std::uint16_t check_sum_of(Bytes frame) {
  return static_cast<std::uint16_t>(frame[frame.size() - 1] << 8 | frame[frame.size() - 2]);
}

bool has_good_check_sum(Bytes frame) {
  return frame.size() >= kRtuShortest &&
         crc16(frame.first(frame.size() - kCheckSum)) == check_sum_of(frame);
}

bool is_function_of_a_read(std::uint8_t code) {
  const int function = code & ~kExceptionBit;
  return function == 3 || function == 4;
}

bool looks_like_tcp(Bytes frame) {
  return frame.size() > kTcpHeader && word_at(frame, 2) == 0 &&
         (word_at(frame, 4) == frame.size() - 6 || is_function_of_a_read(frame[kTcpHeader]));
}

/// Ignores the checksum: checks the function code, and a byte count or exception that fits it.
bool looks_like_damaged_rtu(Bytes frame) {
  if (frame.size() < kRtuShortest || !is_function_of_a_read(frame[1])) return false;
  return (frame[1] & kExceptionBit) != 0 ? frame.size() == kRtuShortest
                                         : frame[2] != 0 && frame[2] % 2 == 0;
}

Framing framing_of(Bytes frame) {
  if (has_good_check_sum(frame)) return Framing::rtu;
  if (looks_like_tcp(frame)) return Framing::tcp;
  return looks_like_damaged_rtu(frame) ? Framing::rtu : Framing::registers;
}

/// Reads a frame from left to right and writes down what it finds.
class Reader {
 public:
  Reader(Bytes frame, Framing framing) : frame_(frame) { found_.framing = framing; }

  FrameExplanation run() {
    if (is_too_short()) return std::move(found_);
    switch (found_.framing) {
      case Framing::tcp:
        tcp_header();
        pdu(frame_.size());
        break;
      case Framing::rtu:
        take(1, fmt::format("unit {}", frame_[0]));
        found_.unit = frame_[0];
        pdu(frame_.size() - kCheckSum);
        check_sum();
        break;
      case Framing::registers:
        registers(frame_.size());
        break;
    }
    return std::move(found_);
  }

 private:
  void take(std::size_t size, std::string meaning) {
    found_.parts.push_back({at_, size, std::move(meaning)});
    at_ += size;
  }
  void problem(std::string sentence) { found_.problems.push_back(std::move(sentence)); }

  bool is_too_short() {
    const std::size_t shortest = found_.framing == Framing::tcp   ? kTcpHeader + 1
                                 : found_.framing == Framing::rtu ? kRtuShortest
                                                                  : 0;
    if (frame_.size() >= shortest) return false;
    problem(fmt::format("a reply on {} has at least {} bytes; these are {}",
                        found_.framing == Framing::tcp ? "TCP" : "a serial line", shortest,
                        frame_.size()));
    rest(frame_.size());
    return true;
  }

  void tcp_header() {
    found_.transaction = word_at(frame_, 0);
    take(2, fmt::format("transaction {}", *found_.transaction));
    const unsigned protocol = word_at(frame_, 2);
    take(2, fmt::format("protocol {}{}", protocol, protocol == 0 ? ", Modbus" : ""));
    if (protocol != 0) problem(fmt::format("the protocol is {}; that of Modbus is 0", protocol));
    const unsigned length = word_at(frame_, 4);
    take(2, fmt::format("{} bytes follow", length));
    if (length != frame_.size() - 6) {
      problem(
          fmt::format("the header says that {} bytes follow, and {} do: the frame is cut short "
                      "or something stands behind it",
                      length, frame_.size() - 6));
    }
    found_.unit = frame_[6];
    take(1, fmt::format("unit {}", frame_[6]));
  }

  /// @param end  Offset past the PDU.
  void pdu(std::size_t end) {
    const std::uint8_t code = frame_[at_];
    found_.function = static_cast<std::uint8_t>(code & ~kExceptionBit);
    if ((code & kExceptionBit) != 0) {
      exception(end);
      return;
    }
    take(1, fmt::format("function {}{}", code,
                        code == 3   ? ", read holding registers"
                        : code == 4 ? ", read input registers"
                                    : ""));
    if (!is_function_of_a_read(code)) {
      problem(fmt::format("function {} is none that recald uses; it reads with 3 and 4", code));
      rest(end);
      return;
    }
    if (end - at_ == 4) {
      problem(
          fmt::format("this is a request, which asks for {} registers from address {}; give it "
                      "with --request, and the reply with --hex",
                      word_at(frame_, at_ + 2), word_at(frame_, at_)));
      rest(end);
      return;
    }
    data(end);
  }

  void exception(std::size_t end) {
    take(1, fmt::format("function {} refused", *found_.function));
    if (end == at_) {
      problem("the frame ends before the exception code");
      return;
    }
    found_.exception_code = frame_[at_];
    take(1, fmt::format("exception {}", describe_exception(*found_.exception_code)));
    if (at_ < end) problem(fmt::format("{} bytes follow the exception code", end - at_));
    rest(end);
  }

  void data(std::size_t end) {
    if (end == at_) {
      problem("the frame ends before its byte count");
      return;
    }
    const std::size_t count = frame_[at_];
    take(1, fmt::format("{} bytes of registers", count));
    if (count == 0 || count % 2 != 0 || count > 2 * kRegistersMax) {
      problem(
          fmt::format("the byte count is {}; registers have an even number of bytes, from 2 to "
                      "{}",
                      count, 2 * kRegistersMax));
    }
    if (count != end - at_) {
      problem(fmt::format("the byte count is {}, and {} bytes of registers are there", count,
                          end - at_));
    }
    const std::size_t there = std::min(count, end - at_);
    registers(at_ + there);
    rest(end);
  }

  void registers(std::size_t end) {
    found_.registers_begin = at_;
    for (; at_ + 2 <= end; at_ += 2) found_.registers.push_back(word_at(frame_, at_));
    if (at_ < end) {
      problem("the registers end with half of one: a byte is missing or too many");
      take(1, "half a register");
    }
  }

  void rest(std::size_t end) {
    if (at_ < end) take(end - at_, "not understood");
  }

  void check_sum() {
    const unsigned stated = check_sum_of(frame_);
    const unsigned computed = crc16(frame_.first(frame_.size() - kCheckSum));
    take(kCheckSum, fmt::format("check sum {:04X}", stated));
    if (stated != computed) {
      problem(
          fmt::format("the check sum is {:04X}, and the bytes before it give {:04X}: bytes are "
                      "wrong, missing or too many",
                      stated, computed));
    }
  }

  Bytes frame_;
  std::size_t at_ = 0;
  FrameExplanation found_;
};

Result<FramedRequest> request_of(Framing framing, Bytes body, std::uint16_t transaction) {
  if (body[1] != 3 && body[1] != 4) {
    return failure(ErrorCode::malformed,
                   fmt::format("the request has function {}; recald reads with 3 and 4", body[1]));
  }
  const ReadRequest request{body[0], static_cast<Function>(body[1]), word_at(body, 2),
                            word_at(body, 4)};
  if (request.count < 1 || request.count > kRegistersMax ||
      request.address + request.count > 0x10000) {
    return failure(ErrorCode::malformed,
                   fmt::format("the request asks for {} registers from address {}; a read has 1 to "
                               "{}, up to address 65535",
                               request.count, request.address, kRegistersMax));
  }
  return FramedRequest{framing, request, transaction};
}

}  // namespace

std::string_view to_string(Framing framing) { return kFramings[static_cast<std::size_t>(framing)]; }

Result<Framing> parse_framing(std::string_view text) {
  for (std::size_t i = 0; i < kFramings.size(); ++i) {
    if (kFramings[i] == text) return static_cast<Framing>(i);
  }
  return failure(ErrorCode::invalid_value,
                 fmt::format("'{}' is no way to frame Modbus; write tcp, rtu or registers", text));
}

Result<std::vector<std::uint8_t>> parse_hex_bytes(std::string_view text) {
  std::vector<std::uint8_t> bytes;
  int high = -1;  // the first digit of a byte; -1: none yet
  const auto digit_of = [](char c) {
    if (c >= '0' && c <= '9') return c - '0';
    if (c >= 'a' && c <= 'f') return c - 'a' + 10;
    return c >= 'A' && c <= 'F' ? c - 'A' + 10 : -1;
  };
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    const bool is_separator = std::string_view{" \t\r\n,:;-[]"}.find(c) != std::string_view::npos;
    const bool is_prefix =
        c == '0' && i + 1 < text.size() && (text[i + 1] | 0x20) == 'x' && high < 0;
    if (is_prefix) ++i;
    if (is_prefix || (is_separator && high < 0)) continue;
    const int digit = digit_of(c);
    if (digit < 0) {
      const std::string shown = std::isprint(static_cast<unsigned char>(c)) != 0
                                    ? fmt::format("'{}'", c)
                                    : fmt::format("0x{:02X}", static_cast<unsigned char>(c));
      return failure(ErrorCode::invalid_value,
                     fmt::format("character {} is {} where a hexadecimal digit should be; write "
                                 "bytes of two digits such as \"01 03 02 00 0A\"",
                                 i + 1, shown));
    }
    if (high < 0) {
      high = digit;
      continue;
    }
    bytes.push_back(static_cast<std::uint8_t>(high << 4 | digit));
    high = -1;
  }
  if (high >= 0)
    return failure(ErrorCode::invalid_value, "the last byte has one digit instead of two");
  if (bytes.empty()) return failure(ErrorCode::invalid_value, "there are no bytes");
  return bytes;
}

FrameExplanation explain_reply(Bytes frame, std::optional<Framing> as) {
  return Reader{frame, as.value_or(framing_of(frame))}.run();
}

Result<FramedRequest> parse_request(Bytes frame) {
  if (frame.size() == 12 && word_at(frame, 2) == 0 && word_at(frame, 4) == 6) {
    return request_of(Framing::tcp, frame.subspan(6), word_at(frame, 0));
  }
  if (frame.size() == 8) {
    if (!has_good_check_sum(frame)) {
      return failure(ErrorCode::malformed,
                     fmt::format("the request's check sum is {:04X}, and its bytes give {:04X}",
                                 check_sum_of(frame), crc16(frame.first(6))));
    }
    return request_of(Framing::rtu, frame.first(6), 0);
  }
  return failure(ErrorCode::malformed,
                 fmt::format("a read request has 8 bytes on a serial line, or 12 on TCP that begin "
                             "with transaction, 0000 and 0006; these are {} bytes",
                             frame.size()));
}

}  // namespace recald::modbus
