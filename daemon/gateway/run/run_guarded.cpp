#include "daemon/gateway/run/run_guarded.hpp"

#include <exception>
#include <optional>
#include <string>

namespace recald::daemon {
namespace {

/// The last exception, and when it was thrown.
class Thrown {
 public:
  /// @return an event to report, or nothing if it was reported recently.
  std::optional<StoreEvent> take(const std::string& what, const Moment& now) {
    if (what == last_ && now.monotonic - at_ < std::chrono::hours{1}) return {};
    last_ = what;
    at_ = now.monotonic;
    return StoreEvent{
        .time = now.instant(),
        .severity = Severity::error,
        .kind = "unforeseen",
        .subject = "",
        .text = "recald met an unforeseen error; it continues, and retries what it can: " + what,
        .is_counted = true};
  }

 private:
  std::string last_;
  std::chrono::milliseconds at_{0};
};

}  // namespace

void run_guarded(boost::asio::io_context& context, const Loop& loop,
                 const std::function<void(StoreEvent)>& note) {
  Thrown thrown;
  while (!context.stopped()) {
    std::string what;
    try {
      context.run();
      continue;
    } catch (const std::exception& exception) {
      what = exception.what();
    } catch (...) {
      what = "no description";
    }
    if (auto event = thrown.take(what, loop.now())) note(std::move(*event));
  }
}

}  // namespace recald::daemon
