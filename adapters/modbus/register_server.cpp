#include "adapters/modbus/register_server.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <modbus/modbus.h>
#include <netdb.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/eventfd.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cassert>
#include <cerrno>
#include <mutex>
#include <optional>
#include <system_error>
#include <thread>
#include <utility>
#include <vector>

#include "adapters/modbus/request_frame.hpp"

namespace recald::modbus {
namespace serving {

class Descriptor {
 public:
  explicit Descriptor(int number) : number_(number) {}
  Descriptor(Descriptor&& other) noexcept : number_(std::exchange(other.number_, -1)) {}
  Descriptor& operator=(Descriptor&& other) noexcept {
    std::swap(number_, other.number_);
    return *this;
  }
  ~Descriptor() {
    if (number_ >= 0) ::close(number_);
  }
  [[nodiscard]] int number() const { return number_; }

 private:
  int number_;
};

struct Client {
  Descriptor socket;
  /// When its last whole request came, or it itself.
  std::chrono::steady_clock::time_point heard_at;
  bool has_asked = false;  ///< At least one request that was Modbus.
  bool is_over = false;
  std::size_t received = 0;
  std::array<std::uint8_t, kTcpFrameMax> bytes{};
};

}  // namespace serving

namespace {

using serving::Descriptor;
using std::chrono::milliseconds;
using std::chrono::steady_clock;

constexpr int kBacklog = 64;
constexpr milliseconds kAcceptAgain{1'000};  // after the process ran out of descriptors

tl::unexpected<Error> no_listener(const RegisterServerOptions& options, const std::string& why) {
  return failure(ErrorCode::io_failed, fmt::format("Modbus registers cannot be served at {}:{}: {}",
                                                   options.address, options.port, why));
}

/// What to do about it, where that is not plain.
std::string listen_words(int error, std::uint16_t port) {
  std::string words = std::generic_category().message(error);
  if (error == EACCES && port < IPPORT_RESERVED) {
    words +=
        "; ports below 1024 need the capability CAP_NET_BIND_SERVICE: allow it, or listen on 1502";
  }
  return words;
}

Result<Descriptor> open_listener(const RegisterServerOptions& options) {
  const addrinfo hints{.ai_flags = AI_NUMERICHOST | AI_NUMERICSERV | AI_PASSIVE,
                       .ai_family = AF_UNSPEC,
                       .ai_socktype = SOCK_STREAM,
                       .ai_protocol = IPPROTO_TCP,
                       .ai_addrlen = 0,
                       .ai_addr = nullptr,
                       .ai_canonname = nullptr,
                       .ai_next = nullptr};
  addrinfo* found = nullptr;
  if (::getaddrinfo(options.address.c_str(), std::to_string(options.port).c_str(), &hints,
                    &found) != 0) {
    return no_listener(options, "this is no IP address");
  }
  const std::unique_ptr<addrinfo, decltype(&::freeaddrinfo)> owned{found, ::freeaddrinfo};
  Descriptor listener{
      ::socket(found->ai_family, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, IPPROTO_TCP)};
  const int on = 1;  // after a restart, connections of the old process may still be closing
  if (listener.number() < 0 ||
      ::setsockopt(listener.number(), SOL_SOCKET, SO_REUSEADDR, &on, sizeof on) != 0 ||
      ::bind(listener.number(), found->ai_addr, found->ai_addrlen) != 0 ||
      ::listen(listener.number(), kBacklog) != 0) {
    return no_listener(options, listen_words(errno, options.port));
  }
  return listener;
}

std::uint16_t port_of(const Descriptor& listener) {
  sockaddr_storage bound{};
  socklen_t size = sizeof bound;
  ::getsockname(listener.number(), reinterpret_cast<sockaddr*>(&bound), &size);
  return ntohs(bound.ss_family == AF_INET6 ? reinterpret_cast<const sockaddr_in6&>(bound).sin6_port
                                           : reinterpret_cast<const sockaddr_in&>(bound).sin_port);
}

}  // namespace

class RegisterServer::Serving {
  using Client = serving::Client;

 public:
  Serving(const RegisterServerOptions& options, Descriptor listener, Descriptor wake,
          modbus_t* encoder, Words registers)
      : options_(options),
        listener_(std::move(listener)),
        wake_(std::move(wake)),
        encoder_(encoder, modbus_free),
        port_(port_of(listener_)),
        registers_(std::make_shared<Words>(std::move(registers))),
        thread_([this](const std::stop_token& stopping) { run(stopping); }) {}

  ~Serving() {
    thread_.request_stop();
    const std::uint64_t one = 1;
    (void)!::write(wake_.number(), &one, sizeof one);
  }
  Serving(const Serving&) = delete;
  Serving& operator=(const Serving&) = delete;

  void set(Words registers) {
    auto next = std::make_shared<Words>(std::move(registers));
    const std::scoped_lock lock{mutex_};
    registers_.swap(next);
  }

  [[nodiscard]] std::uint16_t port() const { return port_; }
  [[nodiscard]] RegisterServerCounts counts() const {
    return {.connections = connections_, .reads = reads_, .refused = refused_, .dropped = dropped_};
  }

 private:
  void run(const std::stop_token& stopping) {
    std::vector<pollfd> waiting;
    while (!stopping.stop_requested()) {
      const auto now = steady_clock::now();
      waiting.clear();
      waiting.push_back({wake_.number(), POLLIN, 0});
      waiting.push_back({now < accept_at_ ? -1 : listener_.number(), POLLIN, 0});
      for (const Client& client : clients_) waiting.push_back({client.socket.number(), POLLIN, 0});
      if (::poll(waiting.data(), waiting.size(), wait_ms(now)) < 0 && errno != EINTR) {
        std::this_thread::sleep_for(kAcceptAgain);  // out of memory: nothing else can be done
        continue;
      }
      serve(waiting);
      if (waiting[1].revents != 0) accept_all();
    }
  }

  /// Until the next connection is idle for too long; -1: for ever.
  [[nodiscard]] int wait_ms(steady_clock::time_point now) const {
    auto until = now < accept_at_ ? accept_at_ : steady_clock::time_point::max();
    for (const Client& client : clients_) {
      until = std::min(until, client.heard_at + options_.idle_max);
    }
    if (until == steady_clock::time_point::max()) return -1;
    const auto wait = std::chrono::ceil<milliseconds>(until - now);
    return static_cast<int>(std::max<std::int64_t>(wait.count(), 0));
  }

  /// @param waiting  As polled: two of ours, then the clients in their order.
  void serve(const std::vector<pollfd>& waiting) {
    const auto now = steady_clock::now();
    for (std::size_t i = 0; i < clients_.size(); ++i) {
      Client& client = clients_[i];
      const bool has_news = waiting[2 + i].revents != 0;
      const bool goes_on = !has_news || take(client, now);
      client.is_over = !goes_on || now - client.heard_at >= options_.idle_max;
    }
    std::erase_if(clients_, [](const Client& client) { return client.is_over; });
  }

  /// @return whether the connection goes on.
  bool take(Client& client, steady_clock::time_point now) {
    const ssize_t came = ::recv(client.socket.number(), client.bytes.data() + client.received,
                                client.bytes.size() - client.received, 0);
    if (came < 0) return errno == EAGAIN || errno == EINTR;
    if (came == 0) return false;
    client.received += static_cast<std::size_t>(came);
    const std::span all{client.bytes.data(), client.received};
    std::size_t taken = 0;
    for (;;) {
      const CutRequest cut = cut_request(all.subspan(taken));
      if (cut.kind == CutRequest::Kind::incomplete) break;
      if (cut.kind == CutRequest::Kind::malformed ||
          !answer(client, all.subspan(taken, cut.size))) {
        ++dropped_;
        return false;
      }
      client.heard_at = now;
      client.has_asked = true;
      taken += cut.size;
    }
    std::copy(all.begin() + static_cast<std::ptrdiff_t>(taken), all.end(), client.bytes.begin());
    client.received -= taken;
    return true;
  }

  /// @return false if the client does not take what it asked for.
  bool answer(const Client& client, std::span<const std::uint8_t> frame) {
    const std::shared_ptr<Words> registers = latest();
    const RequestVerdict verdict = check_request(frame, registers->size());
    modbus_set_socket(encoder_.get(), client.socket.number());
    if (verdict != RequestVerdict::read) {
      ++refused_;
      return modbus_reply_exception(encoder_.get(), frame.data(), static_cast<unsigned>(verdict)) >
             0;
    }
    // Only reads come here, and they leave the mapping as it is.
    modbus_mapping_t mapping{};
    mapping.nb_registers = mapping.nb_input_registers = static_cast<int>(registers->size());
    mapping.tab_registers = mapping.tab_input_registers = registers->data();
    ++reads_;
    return modbus_reply(encoder_.get(), frame.data(), static_cast<int>(frame.size()), &mapping) > 0;
  }

  [[nodiscard]] std::shared_ptr<Words> latest() {
    const std::scoped_lock lock{mutex_};
    return registers_;
  }

  /// As many as there may be at once; the others wait for the next round.
  void accept_all() {
    for (int i = 0; i < options_.connections_max; ++i) {
      Descriptor socket{
          ::accept4(listener_.number(), nullptr, nullptr, SOCK_NONBLOCK | SOCK_CLOEXEC)};
      if (socket.number() < 0) {
        const bool is_done = errno == EAGAIN || errno == ECONNABORTED || errno == EINTR;
        if (!is_done) accept_at_ = steady_clock::now() + kAcceptAgain;
        return;
      }
      const int on = 1;
      ::setsockopt(socket.number(), IPPROTO_TCP, TCP_NODELAY, &on, sizeof on);
      ++connections_;
      if (std::ssize(clients_) >= options_.connections_max) make_room();
      clients_.push_back({.socket = std::move(socket), .heard_at = steady_clock::now()});
    }
  }

  /// As the implementation guide has it (V1.0b, 4.2.1.2), but those that never asked for anything
  /// go first: a flood of connections must not end those of a management system.
  void make_room() {
    clients_.erase(std::ranges::min_element(clients_, {}, [](const Client& one) {
      return std::pair{one.has_asked, one.heard_at};
    }));
  }

  RegisterServerOptions options_;
  Descriptor listener_;
  Descriptor wake_;
  std::unique_ptr<modbus_t, decltype(&modbus_free)> encoder_;
  std::uint16_t port_;
  std::mutex mutex_;
  std::shared_ptr<Words> registers_;
  std::vector<Client> clients_;  ///< Of the thread, as the next one.
  steady_clock::time_point accept_at_{};
  std::atomic<std::uint64_t> connections_{0};
  std::atomic<std::uint64_t> reads_{0};
  std::atomic<std::uint64_t> refused_{0};
  std::atomic<std::uint64_t> dropped_{0};
  std::jthread thread_;  ///< Last: it uses all of the above.
};

Result<std::unique_ptr<RegisterServer>> RegisterServer::listen(const RegisterServerOptions& options,
                                                               Words registers) {
  assert(registers.size() <= 65'536 && options.connections_max >= 1);
  auto listener = TRY(open_listener(options));
  Descriptor wake{::eventfd(0, EFD_CLOEXEC)};
  modbus_t* const encoder = modbus_new_tcp(nullptr, 0);
  if (wake.number() < 0 || encoder == nullptr) {
    modbus_free(encoder);
    return no_listener(options, std::generic_category().message(errno));
  }
  return std::unique_ptr<RegisterServer>{new RegisterServer{std::make_unique<Serving>(
      options, std::move(listener), std::move(wake), encoder, std::move(registers))}};
}

RegisterServer::RegisterServer(std::unique_ptr<Serving> serving) : serving_(std::move(serving)) {}
RegisterServer::~RegisterServer() = default;

void RegisterServer::set(Words registers) { serving_->set(std::move(registers)); }

std::uint16_t RegisterServer::port() const { return serving_->port(); }

RegisterServerCounts RegisterServer::counts() const { return serving_->counts(); }

}  // namespace recald::modbus
