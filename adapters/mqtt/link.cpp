#include "adapters/mqtt/link.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <mosquitto.h>
#include <mqtt_protocol.h>
#include <netdb.h>
#include <openssl/ssl.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <string_view>

#include "adapters/mqtt/tls.hpp"

namespace recald::mqtt {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;
using std::chrono::steady_clock;

constexpr int kKeepAlive_s = 30;
constexpr seconds kAnswer{10};
constexpr std::uint32_t kSession_s = 86'400;
constexpr std::size_t kPayload_bytes_max = 1 << 20;
/// What the broker may send: more than a payload that is taken, so that one which is not can be
/// told of.
constexpr std::uint32_t kPacket_bytes_max = 4 << 20;
constexpr std::uint16_t kUnacknowledged_max = 100;
constexpr int kFailures = 128;  ///< Reason codes from here on are failures (MQTT 5, 2.4).

class Properties {
 public:
  ~Properties() { mosquitto_property_free_all(&list_); }
  Properties() = default;
  Properties(const Properties&) = delete;
  Properties& operator=(const Properties&) = delete;

  void add(int name, std::uint32_t value) { mosquitto_property_add_int32(&list_, name, value); }
  [[nodiscard]] const mosquitto_property* list() const { return list_; }

 private:
  mosquitto_property* list_ = nullptr;
};

/// A reason code in words, with what the broker adds.
std::string reason(int code, const mosquitto_property* properties) {
  std::string words = mosquitto_reason_string(code);
  char* more = nullptr;
  if (mosquitto_property_read_string(properties, MQTT_PROP_REASON_STRING, &more, false) !=
      nullptr) {
    words += fmt::format(" ({})", more);
    std::free(more);
  }
  return words;
}

bool is_refused_login(int code) {
  return code == MQTT_RC_NOT_AUTHORIZED || code == MQTT_RC_BAD_USERNAME_OR_PASSWORD;
}

const char* or_null(const std::string& text) { return text.empty() ? nullptr : text.c_str(); }

/// Bytes of a PUBLISH packet with QoS 1 and without properties (MQTT 5, 3.3).
std::size_t packet_bytes(const Message& message) {
  const std::size_t rest = 2 + message.topic.size() + 2 + 1 + message.payload.size();
  std::size_t length_bytes = 1;
  for (std::size_t left = rest >> 7; left > 0; left >>= 7) ++length_bytes;
  return 1 + length_bytes + rest;
}

/// "error:0A00010B:SSL routines::wrong version number": the words at the end.
std::string_view last_words(std::string_view logged) {
  const std::size_t at = logged.rfind(':');
  return at == std::string_view::npos ? logged : logged.substr(at + 1);
}

}  // namespace

std::string name_of(const Broker& broker) {
  const bool is_ipv6 = broker.host.find(':') != std::string::npos;
  return is_ipv6 ? fmt::format("[{}]:{}", broker.host, broker.port)
                 : fmt::format("{}:{}", broker.host, broker.port);
}

Result<void> check_topic(const std::string& topic) {
  const bool is_text =
      mosquitto_validate_utf8(topic.data(), static_cast<int>(topic.size())) == MOSQ_ERR_SUCCESS &&
      topic.find('\0') == std::string::npos;
  if (is_text && !topic.empty() &&
      mosquitto_pub_topic_check2(topic.data(), topic.size()) == MOSQ_ERR_SUCCESS) {
    return {};
  }
  return failure(
      ErrorCode::invalid_value,
      fmt::format("'{}' is no topic to publish to: a topic is UTF-8 text without + and #", topic));
}

Result<void> check(const Broker& broker, const Session& session) {
  if (broker.host.empty() || broker.port == 0) {
    return failure(ErrorCode::invalid_value,
                   fmt::format("'{}' is no broker: it needs a host and a port", name_of(broker)));
  }
  if (broker.client_id.empty()) {
    return failure(ErrorCode::invalid_value,
                   "a connection to a broker needs a client id: its session is found by that");
  }
  if (broker.certificate_file.empty() != broker.key_file.empty()) {
    return failure(ErrorCode::invalid_value,
                   "a client's certificate and key belong together: one of them is missing");
  }
  for (const auto& message : {session.will, session.birth}) {
    if (!message) continue;
    if (auto good = check_topic(message->topic); !good) return good;
  }
  for (const std::string& topic : session.topics) {
    if (topic.empty() ||
        mosquitto_sub_topic_check2(topic.data(), topic.size()) != MOSQ_ERR_SUCCESS) {
      return failure(ErrorCode::invalid_value,
                     fmt::format("'{}' is no topic to subscribe to: # stands alone at the end, + "
                                 "alone between slashes",
                                 topic));
    }
  }
  return {};
}

/// What the library calls. No exception may pass through it.
struct Link::Callbacks {
  static Link& of(void* link) { return *static_cast<Link*>(link); }

  static void connected(::mosquitto*, void* to, int code, int,
                        const mosquitto_property* properties) noexcept {
    Link& link = of(to);
    if (code != MQTT_RC_SUCCESS) {
      link.why_ =
          fmt::format("{} refused the connection: {}{}", link.name_, reason(code, properties),
                      is_refused_login(code) ? "; check user and password" : "");
      return;
    }
    std::uint16_t at_a_time = kUnacknowledged_max;
    mosquitto_property_read_int16(properties, MQTT_PROP_RECEIVE_MAXIMUM, &at_a_time, false);
    link.unacknowledged_max_ = std::min(at_a_time, kUnacknowledged_max);
    mosquitto_property_read_int32(properties, MQTT_PROP_MAXIMUM_PACKET_SIZE,
                                  &link.packet_bytes_max_, false);
    link.is_connected_ = true;
    link.logged_.clear();
    link.listener_.connected();
    link.begin_session();
  }
  static void disconnected(::mosquitto*, void* to, int code,
                           const mosquitto_property* properties) noexcept {
    Link& link = of(to);
    if (code < kFailures || !link.why_.empty()) return;  // the library's own code
    link.why_ = fmt::format("{} ended the connection: {}", link.name_, reason(code, properties));
  }
  static void published(::mosquitto*, void* to, int id, int code,
                        const mosquitto_property* properties) noexcept {
    Link& link = of(to);
    const std::string refusal = code < kFailures ? "" : reason(code, properties);
    if (id != link.birth_id_) {
      const bool is_for_good = code == MQTT_RC_NOT_AUTHORIZED ||
                               code == MQTT_RC_TOPIC_NAME_INVALID ||
                               code == MQTT_RC_PAYLOAD_FORMAT_INVALID;
      link.listener_.acknowledged(id, refusal, is_for_good);
      return;
    }
    link.birth_id_ = -1;
    if (!refusal.empty()) {
      link.listener_.complain(fmt::format("{} refused the message on {}: {}", link.name_,
                                          link.session_.birth->topic, refusal));
    }
  }
  static void subscribed(::mosquitto*, void* to, int, int count, const int* codes,
                         const mosquitto_property* properties) noexcept {
    Link& link = of(to);
    const auto& topics = link.session_.topics;
    for (std::size_t i = 0; i < std::min(topics.size(), static_cast<std::size_t>(count)); ++i) {
      if (codes[i] < kFailures) continue;
      link.listener_.complain(fmt::format("{} refused the subscription to {}: {}", link.name_,
                                          topics[i], reason(codes[i], properties)));
    }
  }
  static void received(::mosquitto*, void* to, const mosquitto_message* message,
                       const mosquitto_property*) noexcept {
    Link& link = of(to);
    const auto size = static_cast<std::size_t>(message->payloadlen);
    if (size > kPayload_bytes_max) {
      link.listener_.complain(fmt::format(
          "{}: a message on {} was dropped: it is longer than 1 MiB", link.name_, message->topic));
      return;
    }
    link.listener_.received({.topic = message->topic,
                             .payload{static_cast<const char*>(message->payload), size},
                             .is_retained = message->retain});
  }
  static void logged(::mosquitto*, void* to, int level, const char* text) noexcept {
    if (level == MOSQ_LOG_ERR) of(to).logged_ = text;
  }
};

Link::Link(const Broker& broker, const Session& session, LinkListener& listener)
    : name_{name_of(broker)}, broker_{broker}, session_{session}, listener_{listener} {}

Link::~Link() { mosquitto_destroy(client_); }

Result<std::unique_ptr<Link>> Link::make(const Broker& broker, const Session& session,
                                         LinkListener& listener) {
  static const int initialised = mosquitto_lib_init();
  std::unique_ptr<Link> link{new Link{broker, session, listener}};
  // A session that is kept outlives the connection.
  link->client_ = initialised == MOSQ_ERR_SUCCESS
                      ? mosquitto_new(broker.client_id.c_str(), !session.is_kept, link.get())
                      : nullptr;
  ::mosquitto* const client = link->client_;
  if (client == nullptr) {
    return failure(ErrorCode::io_failed, "no connection to " + link->name_ +
                                             " can be made: memory or file descriptors ran out");
  }
  // As if another thread called step(): what is to be sent is queued, and written there, the
  // acknowledgement of a message after received() has returned.
  mosquitto_threaded_set(client, true);
  mosquitto_int_option(client, MOSQ_OPT_PROTOCOL_VERSION, MQTT_PROTOCOL_V5);
  mosquitto_int_option(client, MOSQ_OPT_SEND_MAXIMUM, kUnacknowledged_max);
  mosquitto_int_option(client, MOSQ_OPT_TCP_NODELAY, 1);
  int code = mosquitto_username_pw_set(client, or_null(broker.user), or_null(broker.password));
  if (code == MOSQ_ERR_SUCCESS && session.will) {
    code = mosquitto_will_set_v5(
        client, session.will->topic.c_str(), static_cast<int>(session.will->payload.size()),
        session.will->payload.data(), 1, session.will->is_retained, nullptr);
  }
  if (code != MOSQ_ERR_SUCCESS) {
    return failure(ErrorCode::invalid_value,
                   fmt::format("user or will of the connection to {} cannot be used: {}",
                               link->name_, mosquitto_strerror(code)));
  }
  if (broker.is_tls) {
    auto context = TRY(make_tls_context(broker, link->certificate_fault_));
    mosquitto_int_option(client, MOSQ_OPT_SSL_CTX_WITH_DEFAULTS, 0);
    mosquitto_void_option(client, MOSQ_OPT_SSL_CTX, context.get());  // shares it
  }
  mosquitto_connect_v5_callback_set(client, Callbacks::connected);
  mosquitto_disconnect_v5_callback_set(client, Callbacks::disconnected);
  mosquitto_publish_v5_callback_set(client, Callbacks::published);
  mosquitto_subscribe_v5_callback_set(client, Callbacks::subscribed);
  mosquitto_message_v5_callback_set(client, Callbacks::received);
  mosquitto_log_callback_set(client, Callbacks::logged);
  return link;
}

Result<void> Link::connect() {
  Properties properties;
  if (session_.is_kept) properties.add(MQTT_PROP_SESSION_EXPIRY_INTERVAL, kSession_s);
  properties.add(MQTT_PROP_MAXIMUM_PACKET_SIZE, kPacket_bytes_max);
  certificate_fault_ = X509_V_OK;
  const int code = mosquitto_connect_bind_v5(client_, broker_.host.c_str(), broker_.port,
                                             kKeepAlive_s, nullptr, properties.list());
  const int system_error = errno;
  answer_due_ = steady_clock::now() + kAnswer;
  if (code == MOSQ_ERR_SUCCESS) {
    // The will is sent when the last process that holds the socket has ended.
    ::fcntl(mosquitto_socket(client_), F_SETFD, FD_CLOEXEC);
    return {};
  }
  if (code == MOSQ_ERR_TLS) return lost(code, system_error);
  const char* const why = code == MOSQ_ERR_EAI     ? ::gai_strerror(system_error)
                          : code == MOSQ_ERR_ERRNO ? std::strerror(system_error)
                                                   : mosquitto_strerror(code);
  return failure(ErrorCode::io_failed, fmt::format("{} cannot be reached: {}", name_, why));
}

Result<void> Link::step(int wake, milliseconds time_max) {
  auto* const tls = static_cast<SSL*>(mosquitto_ssl_get(client_));
  const bool has_more = tls != nullptr && SSL_pending(tls) > 0;
  const short interest = mosquitto_want_write(client_) ? POLLIN | POLLOUT : POLLIN;
  std::array<::pollfd, 2> events{{{mosquitto_socket(client_), interest, 0}, {wake, POLLIN, 0}}};
  ::poll(events.data(), events.size(), has_more ? 0 : static_cast<int>(time_max.count()));
  if (events[1].revents != 0) {
    std::uint64_t ignored = 0;
    (void)!::read(wake, &ignored, sizeof ignored);
  }
  int code = MOSQ_ERR_SUCCESS;
  if (events[0].revents != 0 || has_more) code = mosquitto_loop_read(client_, 1);
  if (code == MOSQ_ERR_SUCCESS && mosquitto_want_write(client_)) {
    code = mosquitto_loop_write(client_, 1);
  }
  if (code == MOSQ_ERR_SUCCESS) code = mosquitto_loop_misc(client_);
  const int system_error = errno;
  // While it shakes hands the library takes a connection that was reset for one that is slow.
  const bool is_gone = !is_connected_ && (events[0].revents & (POLLHUP | POLLERR)) != 0;
  if (code != MOSQ_ERR_SUCCESS || mosquitto_socket(client_) < 0) return lost(code, system_error);
  if (is_gone) return lost(MOSQ_ERR_CONN_LOST, 0);
  if (!is_connected_ && steady_clock::now() > answer_due_) {
    return failure(ErrorCode::io_failed,
                   fmt::format("{} did not answer within {} s", name_, kAnswer.count()));
  }
  return {};
}

tl::unexpected<Error> Link::lost(int code, int system_error) const {
  if (!why_.empty()) return failure(ErrorCode::io_failed, why_);
  if (certificate_fault_ != X509_V_OK) {
    return failure(ErrorCode::io_failed,
                   fmt::format("{} is not trusted: its certificate has this fault: {}", name_,
                               X509_verify_cert_error_string(certificate_fault_)));
  }
  const std::string_view logged = last_words(logged_);
  const bool is_closed = code == MOSQ_ERR_CONN_LOST || logged == "unexpected eof while reading" ||
                         (code == MOSQ_ERR_TLS && logged.empty());
  if (!logged.empty() && !is_closed) {
    return failure(ErrorCode::io_failed,
                   fmt::format("{}: the connection failed: {}", name_, logged));
  }
  const std::string_view why = is_closed                    ? "the broker closed it without a word"
                               : code == MOSQ_ERR_KEEPALIVE ? "the broker fell silent"
                               : code == MOSQ_ERR_ERRNO     ? std::strerror(system_error)
                                                            : mosquitto_strerror(code);
  return failure(ErrorCode::io_failed, fmt::format("{}: the connection is lost: {}", name_, why));
}

void Link::begin_session() {
  if (!session_.topics.empty()) {
    std::vector<char*> topics;
    for (const std::string& topic : session_.topics)
      topics.push_back(const_cast<char*>(topic.c_str()));
    const int code = mosquitto_subscribe_multiple(client_, nullptr, static_cast<int>(topics.size()),
                                                  topics.data(), 1, 0, nullptr);
    if (code != MOSQ_ERR_SUCCESS) {
      listener_.complain(
          fmt::format("{}: the topics cannot be subscribed: {}", name_, mosquitto_strerror(code)));
    }
  }
  if (!session_.birth) return;
  const auto id = publish(*session_.birth);
  if (id) {
    birth_id_ = *id;
  } else {
    listener_.complain(id.error().message);
  }
}

Result<int> Link::publish(const Message& message) {
  if (packet_bytes_max_ > 0 && packet_bytes(message) > packet_bytes_max_) {
    return failure(ErrorCode::out_of_range,
                   fmt::format("a message on {} is too long for {}: {} bytes, it takes {}",
                               message.topic, name_, packet_bytes(message), packet_bytes_max_));
  }
  int id = -1;
  const int code = mosquitto_publish_v5(client_, &id, message.topic.c_str(),
                                        static_cast<int>(message.payload.size()),
                                        message.payload.data(), 1, message.is_retained, nullptr);
  if (code == MOSQ_ERR_SUCCESS) return id;
  return failure(ErrorCode::io_failed, fmt::format("{} cannot be sent a message on {}: {}", name_,
                                                   message.topic, mosquitto_strerror(code)));
}

void Link::say_goodbye(milliseconds time_max) {
  if (!is_connected_) return;
  const auto due = steady_clock::now() + time_max;
  const auto wait_for = [&due](int socket, short event) {
    const auto left = std::chrono::duration_cast<milliseconds>(due - steady_clock::now());
    ::pollfd events{socket, event, 0};
    return left.count() > 0 && ::poll(&events, 1, static_cast<int>(left.count())) > 0;
  };
  // The library closes the socket behind its last word. Were anything unread then, the broker would
  // see a reset and might not read that word, so the socket is kept open until the broker closes
  // it.
  const int socket = ::fcntl(mosquitto_socket(client_), F_DUPFD_CLOEXEC, 0);
  mosquitto_disconnect_v5(client_, MQTT_RC_SUCCESS, nullptr);
  while (mosquitto_socket(client_) >= 0 && wait_for(mosquitto_socket(client_), POLLOUT)) {
    if (mosquitto_loop_write(client_, 1) != MOSQ_ERR_SUCCESS) break;
  }
  ::shutdown(socket, SHUT_WR);
  std::array<char, 4096> ignored{};
  while (wait_for(socket, POLLIN) && ::read(socket, ignored.data(), ignored.size()) > 0) {
  }
  ::close(socket);
}

}  // namespace recald::mqtt
