/// One connection to a broker, from its beginning to its loss. Used by one thread.
///
/// A new one for each attempt, so that nothing which waited in the library is sent after a loss:
/// whoever published it was told of the loss, and sends it again.
#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <string>

#include "adapters/mqtt/message.hpp"
#include "core/result.hpp"

struct mosquitto;

namespace recald::mqtt {

/// The broker as messages name it: "host:port".
[[nodiscard]] std::string name_of(const Broker& broker);

/// @return or invalid_value: no topic that a message can be published to.
[[nodiscard]] Result<void> check_topic(const std::string& topic);
/// @return or invalid_value: a broker, a topic or a filter that cannot be.
[[nodiscard]] Result<void> check(const Broker& broker, const Session& session);

/// What a link tells its owner, from within step().
class LinkListener {
 public:
  virtual ~LinkListener() = default;
  virtual void connected() = 0;
  virtual void received(const Message& message) = 0;
  /// @param refusal      Why the broker did not take the message; empty: it did.
  /// @param is_for_good  It will not take the same message later either.
  virtual void acknowledged(int id, const std::string& refusal, bool is_for_good) = 0;
  /// The connection is good, but something else is not.
  virtual void complain(const std::string& sentence) = 0;
};

class Link {
 public:
  /// @param session, listener  Outlive it.
  static Result<std::unique_ptr<Link>> make(const Broker& broker, const Session& session,
                                            LinkListener& listener);
  ~Link();
  Link(const Link&) = delete;
  Link& operator=(const Link&) = delete;

  /// Blocks, for minutes if a name server or the broker's machine is silent.
  Result<void> connect();
  /// Waits for the network, or for `wake` (an eventfd, which it empties), and does what there is to
  /// do.
  /// @return or io_failed: the connection is lost or was refused.
  Result<void> step(int wake, std::chrono::milliseconds time_max);

  /// Begins to publish. @return what acknowledged() will call it, or out_of_range: longer than the
  /// broker takes; io_failed.
  Result<int> publish(const Message& message);
  /// How many may be unacknowledged at a time.
  [[nodiscard]] std::size_t unacknowledged_max() const { return unacknowledged_max_; }

  /// Sends what waits, and DISCONNECT.
  void say_goodbye(std::chrono::milliseconds time_max);

 private:
  struct Callbacks;

  Link(const Broker& broker, const Session& session, LinkListener& listener);
  [[nodiscard]] tl::unexpected<Error> lost(int code, int system_error) const;
  void begin_session();

  std::string name_;
  Broker broker_;
  const Session& session_;
  LinkListener& listener_;
  ::mosquitto* client_ = nullptr;
  std::chrono::steady_clock::time_point answer_due_;
  bool is_connected_ = false;
  int birth_id_ = -1;
  std::size_t unacknowledged_max_ = 0;
  std::uint32_t packet_bytes_max_ = 0;  ///< 0: no limit.
  std::string why_;                     ///< What the broker said when it ended the connection.
  long certificate_fault_ = 0;          ///< X509_V_OK, or why the broker is not trusted.
  std::string logged_;                  ///< The library's last error, for what only it knows.
};

}  // namespace recald::mqtt
