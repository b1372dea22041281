#include "daemon/gateway/forward/broker_state.hpp"

#include <algorithm>
#include <span>
#include <utility>

#include "daemon/gateway/forward/state_messages.hpp"

namespace recald::daemon {
namespace {

constexpr std::chrono::minutes kEvery{1};
constexpr std::size_t kPart = 200;  // messages that are done before the next ones begin
constexpr std::chrono::seconds kStatePublishMax{10};

}  // namespace

BrokerState::BrokerState(Loop& loop, std::unique_ptr<Worker> worker,
                         std::shared_ptr<const SiteConfig> site, std::shared_ptr<BrokerLink> link)
    : loop_(loop), site_(std::move(site)), link_(std::move(link)), worker_(std::move(worker)) {}

BrokerState::~BrokerState() { stop_.request_stop(); }

void BrokerState::begin_anew() {
  published_.clear();
  not_before_.reset();
  is_anew_ = is_publishing_;
}

void BrokerState::set(const SiteFacts& facts) {
  const auto now = loop_.now().monotonic;
  if (is_publishing_ || now < not_before_.value_or(now) || !link_->is_connected()) return;
  not_before_ = now + kEvery;
  auto messages = state_messages(*site_, facts);
  std::ranges::move(discovery_messages(*site_), std::back_inserter(messages));
  std::erase_if(messages, [&](const mqtt::Message& message) {
    const auto known = published_.find(message.topic);
    return known != published_.end() && known->second == message.payload;
  });
  if (messages.empty()) return;
  is_publishing_ = true;
  const auto shared = std::make_shared<const std::vector<mqtt::Message>>(std::move(messages));
  const auto published = std::make_shared<std::size_t>(0);
  worker_->run(
      [link = link_, shared, published, stop = stop_.get_token()] {
        for (std::size_t& done = *published; done < shared->size();) {
          const auto part =
              std::span{*shared}.subspan(done, std::min(kPart, shared->size() - done));
          if (!link->publish(part, kStatePublishMax, stop)) return;
          done += part.size();
        }
      },
      alive_.guard([this, shared, published] { finish(std::span{*shared}.first(*published)); }));
}

void BrokerState::finish(std::span<const mqtt::Message> published) {
  is_publishing_ = false;
  if (std::exchange(is_anew_, false)) return;
  for (const mqtt::Message& message : published) published_[message.topic] = message.payload;
}

}  // namespace recald::daemon
