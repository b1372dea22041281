/// Serves registers over Modbus TCP, to be read and never to be written.
#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <string>

#include "adapters/ports/register_read.hpp"
#include "core/result.hpp"

namespace recald::modbus {

struct RegisterServerOptions {
  std::string address = "127.0.0.1";  ///< Of one interface, as a number.
  std::uint16_t port = 502;           ///< 0: one that is free.
  int connections_max = 16;           ///< One more takes the place of the one idle for longest.
  std::chrono::milliseconds idle_max{300'000};  ///< A connection without a request is closed.
};

/// What clients did so far.
struct RegisterServerCounts {
  std::uint64_t connections = 0;  ///< Accepted.
  std::uint64_t reads = 0;        ///< Answered with registers.
  std::uint64_t refused = 0;      ///< Answered with an exception.
  std::uint64_t dropped = 0;      ///< Connections that did not speak Modbus, or took no answers.
};

/// Has a thread of its own, which waits for all connections at once: a client that sends half a
/// frame, or nothing, delays no other.
///
/// Functions 3 and 4 read the same registers, which begin at address 0, at any unit. Everything
/// else is answered with an exception: 1 for other functions, 2 for addresses that are not there,
/// 3 for wrong counts. What is no Modbus TCP at all ends its connection.
class RegisterServer {
 public:
  /// @param registers  At most 65 536.
  /// @return or io_failed: the address is not this machine's, is in use, or the port is below 1024
  ///         and the process may not have it.
  [[nodiscard]] static Result<std::unique_ptr<RegisterServer>> listen(
      const RegisterServerOptions& options, Words registers);
  ~RegisterServer();
  RegisterServer(const RegisterServer&) = delete;
  RegisterServer& operator=(const RegisterServer&) = delete;

  /// Replaces all registers at once: an answer has those from before or those from after. From any
  /// thread.
  void set(Words registers);

  [[nodiscard]] std::uint16_t port() const;
  [[nodiscard]] RegisterServerCounts counts() const;

 private:
  class Serving;
  explicit RegisterServer(std::unique_ptr<Serving> serving);
  std::unique_ptr<Serving> serving_;
};

}  // namespace recald::modbus
