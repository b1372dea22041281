/// Sockets of this machine alone.
#pragma once

#include <arpa/inet.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cstdint>

namespace recald::testing {

/// @param port  0: any that is free.
inline ::sockaddr_in loopback(std::uint16_t port) {
  ::sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(port);
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  return address;
}

/// Binds a socket to a free port. @return the port; 0: it cannot be.
inline std::uint16_t bind_to_free_port(int socket) {
  ::sockaddr_in address = loopback(0);
  ::socklen_t size = sizeof address;
  const bool is_bound = ::bind(socket, reinterpret_cast<::sockaddr*>(&address), size) == 0 &&
                        ::getsockname(socket, reinterpret_cast<::sockaddr*>(&address), &size) == 0;
  return is_bound ? ntohs(address.sin_port) : 0;
}

/// One that was free a moment ago.
inline std::uint16_t free_port() {
  const int socket = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
  const std::uint16_t port = bind_to_free_port(socket);
  ::close(socket);
  return port;
}

}  // namespace recald::testing
