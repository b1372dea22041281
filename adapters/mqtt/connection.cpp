#include "adapters/mqtt/connection.hpp"

#include <fmt/format.h>
#include <sys/eventfd.h>
#include <unistd.h>

#include <algorithm>
#include <cassert>
#include <condition_variable>
#include <cstdint>
#include <map>
#include <mutex>
#include <random>
#include <set>
#include <thread>
#include <utility>

#include "adapters/mqtt/link.hpp"
#include "core/text/printable.hpp"

namespace recald::mqtt {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;
using std::chrono::steady_clock;
using Duration = std::chrono::duration<double>;

constexpr double kBetweenAttempts_s_max = 60.0;
constexpr milliseconds kStep{1000};  ///< The library's own clock ticks in seconds.
constexpr milliseconds kGoodbye{1000};

/// Whether it was not said before. What a broker says is remembered up to a limit, and not told
/// again beyond it.
bool is_news(std::set<std::string>& reported, const std::string& sentence) {
  constexpr std::size_t kReported_max = 1000;
  return reported.size() < kReported_max && reported.insert(sentence).second;
}

}  // namespace

/// Shared with the thread: one that looks up a name cannot be stopped, and is left to end by
/// itself.
class Connection::Client final : private LinkListener {
 public:
  Client(Broker broker, Session session, OnMessage on_message, OnState on_state)
      : broker_{std::move(broker)},
        session_{std::move(session)},
        on_message_{std::move(on_message)},
        on_state_{std::move(on_state)},
        name_{name_of(broker_)},
        wake_{::eventfd(0, EFD_NONBLOCK | EFD_CLOEXEC)} {}
  ~Client() override { ::close(wake_); }

  void run();
  /// @return whether the thread is to be left to itself: it calls nobody any more.
  bool stop();
  Result<void> publish(std::span<const Message> messages, milliseconds time_max,
                       const std::stop_token& stop);
  bool is_connected() const {
    const std::scoped_lock lock{mutex_};
    return is_connected_;
  }
  Result<std::unique_ptr<Link>> make_link() { return Link::make(broker_, session_, *this); }

 private:
  /// What one call of publish() waits for.
  struct Publication {
    std::span<const Message> messages;
    std::size_t begun = 0;
    std::size_t acknowledged = 0;
    std::optional<Result<void>> outcome{};
  };
  struct InFlight {
    std::uint64_t publication;
    std::size_t index;
  };

  void connected() override;
  void received(const Message& message) override { on_message_(message); }
  void acknowledged(int id, const std::string& refusal, bool is_for_good) override;
  void complain(const std::string& sentence) override;

  Error stay_connected();
  void begin_to_publish(Link& link);
  void lose(const Error& why);
  void wake() const;
  bool is_stopping() const {
    const std::scoped_lock lock{mutex_};
    return is_stopping_;
  }

  const Broker broker_;
  const Session session_;
  const OnMessage on_message_;
  const OnState on_state_;
  const std::string name_;
  const int wake_;

  // Of the thread alone.
  std::map<int, InFlight> in_flight_;
  std::set<std::string> reported_;    ///< Causes since the last good connection.
  std::set<std::string> complaints_;  ///< Ever.
  std::optional<steady_clock::time_point> connected_at_;

  mutable std::mutex mutex_;
  std::condition_variable_any changed_;
  // Guarded by it.
  Publication* publication_ = nullptr;
  std::uint64_t publication_number_ = 0;
  bool is_connected_ = false;
  bool is_connecting_ = false;  ///< In a call that cannot be stopped.
  bool is_stopping_ = false;
  bool has_ended_ = false;
  std::string why_ = "it has not answered yet";
};

void Connection::Client::run() {
  std::mt19937 random{std::random_device{}()};
  double longest_s = 1.0;
  Duration waited{0.0};
  while (!is_stopping()) {
    connected_at_.reset();
    const Error why = stay_connected();
    if (is_stopping()) break;
    lose(why);
    // Two clients of one id throw each other out: a short connection is as bad as none.
    if (connected_at_ && steady_clock::now() - *connected_at_ > waited) longest_s = 1.0;
    longest_s = std::min(2.0 * longest_s, kBetweenAttempts_s_max);
    waited = Duration{std::uniform_real_distribution{1.0, longest_s}(random)};
    std::unique_lock lock{mutex_};
    changed_.wait_for(lock, waited, [this] { return is_stopping_; });
  }
  const std::scoped_lock lock{mutex_};
  has_ended_ = true;
  changed_.notify_all();
}

Error Connection::Client::stay_connected() {
  const auto link = make_link();
  if (!link) return link.error();
  {
    const std::scoped_lock lock{mutex_};
    is_connecting_ = true;
  }
  auto goes_on = (*link)->connect();
  {
    const std::scoped_lock lock{mutex_};
    is_connecting_ = false;
    if (is_stopping_) return {ErrorCode::cancelled, ""};
  }
  while (goes_on && !is_stopping()) {
    begin_to_publish(**link);
    goes_on = (*link)->step(wake_, kStep);
  }
  if (!goes_on) return goes_on.error();
  (*link)->say_goodbye(kGoodbye);
  return {ErrorCode::cancelled, ""};
}

void Connection::Client::begin_to_publish(Link& link) {
  const std::scoped_lock lock{mutex_};
  Publication* const now = publication_;
  while (now != nullptr && !now->outcome && now->begun < now->messages.size() &&
         in_flight_.size() < link.unacknowledged_max()) {
    const auto id = link.publish(now->messages[now->begun]);
    if (!id) {
      now->outcome = tl::unexpected(id.error());
      changed_.notify_all();
      return;
    }
    in_flight_.insert_or_assign(*id, InFlight{publication_number_, now->begun++});
  }
}

void Connection::Client::acknowledged(int id, const std::string& refusal, bool is_for_good) {
  const auto found = in_flight_.find(id);
  if (found == in_flight_.end()) return;
  const InFlight about = found->second;
  in_flight_.erase(found);
  const std::scoped_lock lock{mutex_};
  // One that nobody waits for any more was said to have failed.
  if (publication_ == nullptr || publication_number_ != about.publication) return;
  if (publication_->outcome) return;
  if (!refusal.empty()) {
    publication_->outcome =
        failure(is_for_good ? ErrorCode::unsupported : ErrorCode::io_failed,
                fmt::format("{} refused the message on {}: {}", name_,
                            publication_->messages[about.index].topic, refusal));
  } else if (++publication_->acknowledged == publication_->messages.size()) {
    publication_->outcome = Result<void>{};
  }
  if (publication_->outcome) changed_.notify_all();
}

void Connection::Client::connected() {
  connected_at_ = steady_clock::now();
  reported_.clear();
  {
    const std::scoped_lock lock{mutex_};
    is_connected_ = true;
  }
  on_state_(true, "");
}

void Connection::Client::lose(const Error& why) {
  in_flight_.clear();
  {
    const std::scoped_lock lock{mutex_};
    is_connected_ = false;
    why_ = why.message;
    if (publication_ != nullptr && !publication_->outcome) {
      publication_->outcome = tl::unexpected(why);
      changed_.notify_all();
    }
  }
  if (is_news(reported_, why.message)) on_state_(false, why.message);
}

void Connection::Client::complain(const std::string& sentence) {
  if (is_news(complaints_, sentence)) on_state_(true, printable(sentence));
}

Result<void> Connection::Client::publish(std::span<const Message> messages, milliseconds time_max,
                                         const std::stop_token& stop) {
  for (const Message& message : messages) {
    if (auto good = check_topic(message.topic); !good) return good;
  }
  Publication publication{.messages = messages};
  std::unique_lock lock{mutex_};
  if (!is_connected_) {
    return failure(ErrorCode::io_failed, fmt::format("{} is not connected: {}", name_, why_));
  }
  if (messages.empty()) return {};
  assert(publication_ == nullptr && "one caller at a time");
  publication_ = &publication;
  ++publication_number_;
  wake();
  changed_.wait_for(lock, stop, time_max,
                    [&publication] { return publication.outcome.has_value(); });
  publication_ = nullptr;
  if (publication.outcome) return *publication.outcome;
  if (stop.stop_requested()) return failure(ErrorCode::cancelled, "publishing was stopped");
  return failure(ErrorCode::io_failed, fmt::format("{} acknowledged {} of {} messages within {} s",
                                                   name_, publication.acknowledged, messages.size(),
                                                   Duration{time_max}.count()));
}

bool Connection::Client::stop() {
  std::unique_lock lock{mutex_};
  is_stopping_ = true;
  wake();
  changed_.notify_all();
  changed_.wait_for(lock, kGoodbye, [this] { return has_ended_; });
  return is_connecting_;
}

void Connection::Client::wake() const {
  constexpr std::uint64_t kOnce = 1;
  (void)!::write(wake_, &kOnce, sizeof kOnce);
}

Result<std::unique_ptr<Connection>> Connection::open(Broker broker, Session session,
                                                     OnMessage on_message, OnState on_state) {
  TRY(check(broker, session));
  auto client = std::make_shared<Client>(std::move(broker), std::move(session),
                                         std::move(on_message), std::move(on_state));
  // Certificates, keys and the like are wrong now, not at each attempt.
  TRY(client->make_link());
  return std::unique_ptr<Connection>{new Connection{std::move(client)}};
}

Connection::Connection(std::shared_ptr<Client> client)
    : client_{std::move(client)}, thread_{[shared = client_] { shared->run(); }} {}

Connection::~Connection() {
  if (client_->stop()) {
    thread_.detach();
  } else {
    thread_.join();
  }
}

Result<void> Connection::publish(std::span<const Message> messages, milliseconds time_max,
                                 const std::stop_token& stop) {
  return client_->publish(messages, time_max, stop);
}

bool Connection::is_connected() const { return client_->is_connected(); }

}  // namespace recald::mqtt
