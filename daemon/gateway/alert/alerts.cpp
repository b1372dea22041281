#include "daemon/gateway/alert/alerts.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <utility>

#include "adapters/http/url.hpp"

namespace recald::daemon {
namespace {

using namespace std::chrono_literals;

constexpr std::size_t kRecentMax = 1'000;

// The first is for the end of quiet hours: what happens is announced.
constexpr ForwardRules kAlertRules{.poll_every = 1min, .retry_min = 1min, .retry_max = 1h};

/// A mail or a POST of all events of a batch.
class AlertSink final : public Sink {
 public:
  AlertSink(std::shared_ptr<const SiteConfig> site, metering::LocalCalendar calendar,
            AlertDestination destination, Deliver deliver)
      : site_(std::move(site)),
        calendar_(std::move(calendar)),
        destination_(std::move(destination)),
        deliver_(std::move(deliver)) {}

  Sent send(const OutgoingBatch& batch, const std::stop_token& stop) override {
    if (batch.size() == 0) return {};  // it is its own trial: only a message shows what is taken
    const auto sent =
        deliver_(destination_, alert_message(*site_, calendar_, batch.events, batch.time), stop);
    if (sent) return {};
    const bool is_refused = sent.error().code == ErrorCode::out_of_range;
    return {.outcome = is_refused ? Sent::Outcome::refused : Sent::Outcome::later,
            .why = sent.error().message};
  }

 private:
  std::shared_ptr<const SiteConfig> site_;
  metering::LocalCalendar calendar_;
  AlertDestination destination_;
  Deliver deliver_;
};

}  // namespace

Destination destination_of(const AlertDestination& destination) {
  if (const auto* const webhook = std::get_if<WebhookConfig>(&destination)) {
    const auto url = http::parse_url(webhook->url);
    return {.id = destination_id("webhook", webhook->url),
            .words = "webhook at " + (url ? url->host : "?")};
  }
  const auto& mail = std::get<MailConfig>(destination);
  return {.id = destination_id("mail", fmt::format("{} {}", mail.server, fmt::join(mail.to, " "))),
          .words = fmt::format("mail to {}", fmt::join(mail.to, ", "))};
}

Alerts::Alerts(Ports ports, std::shared_ptr<const SiteConfig> site,
               metering::LocalCalendar calendar, Deliver deliver, Outbox::Notify notify,
               Notified notified)
    : ports_(std::move(ports)),
      calendar_(std::move(calendar)),
      deliver_(std::move(deliver)),
      notify_(std::move(notify)),
      memory_{.notified = std::move(notified)} {
  set_site(std::move(site));
}

void Alerts::set_site(std::shared_ptr<const SiteConfig> site) {
  // All are told before the first is waited for.
  for (const auto& forwarder : forwarders_) forwarder->stop();
  forwarders_.clear();
  for (const AlertDestination& destination : site->alerts.destinations) {
    Destination to = destination_of(destination);
    // Twice in the file is once: there is one cursor.
    const bool is_there = std::ranges::any_of(
        forwarders_, [&](const auto& one) { return one->destination().id == to.id; });
    if (is_there) continue;
    auto outbox = std::make_unique<AlertOutbox>(ports_.loop, ports_.store, memory_, std::move(to),
                                                notify_, site, calendar_);
    forwarders_.push_back(std::make_unique<Forwarder>(
        ports_.loop, ports_.make_worker(), std::move(outbox),
        std::make_unique<AlertSink>(site, calendar_, destination, deliver_), kAlertRules));
    forwarders_.back()->poll_within(kGatherAlerts);
  }
}

void Alerts::observe(const StoreEvent& event) {
  const auto now = ports_.loop.now().monotonic;
  auto& recent = memory_.recent;
  if (!memory_.store_refuses) {
    std::erase_if(recent, [&](const auto& one) { return now - one.at > kGatherAlerts; });
  }
  if (event.kind == "store_refuses") memory_.store_refuses = true;
  if (event.kind == "store_accepts") memory_.store_refuses = false;
  recent.push_back({event, now});
  while (recent.size() > kRecentMax) recent.pop_front();
  for (const auto& forwarder : forwarders_) forwarder->poll_within(kGatherAlerts);
}

}  // namespace recald::daemon
