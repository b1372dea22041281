#include "daemon/gateway/forward/broker_state.hpp"

#include <algorithm>
#include <utility>

#include "daemon/gateway/forward/state_messages.hpp"

namespace recald::daemon {
namespace {

constexpr std::chrono::minutes kEvery{1};
constexpr std::chrono::seconds kStatePublishMax{10};

}  // namespace

BrokerState::BrokerState(Loop& loop, std::unique_ptr<Worker> worker,
                         std::shared_ptr<const SiteConfig> site, std::shared_ptr<BrokerLink> link)
    : loop_(loop),
      site_(std::move(site)),
      link_(std::move(link)),
      self_(std::make_shared<BrokerState*>(this)),
      worker_(std::move(worker)) {}

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
  auto messages = discovery_messages(*site_);
  std::ranges::move(state_messages(*site_, facts), std::back_inserter(messages));
  std::erase_if(messages, [&](const mqtt::Message& message) {
    const auto known = published_.find(message.topic);
    return known != published_.end() && known->second == message.payload;
  });
  if (messages.empty()) return;
  is_publishing_ = true;
  const auto shared = std::make_shared<const std::vector<mqtt::Message>>(std::move(messages));
  const auto is_published = std::make_shared<bool>(false);
  worker_->run(
      [link = link_, shared, is_published, stop = stop_.get_token()] {
        *is_published = link->publish(*shared, kStatePublishMax, stop).has_value();
      },
      [weak = std::weak_ptr{self_}, shared, is_published] {
        if (const auto self = weak.lock()) (*self)->finish(*shared, *is_published);
      });
}

void BrokerState::finish(const std::vector<mqtt::Message>& messages, bool is_published) {
  is_publishing_ = false;
  if (std::exchange(is_anew_, false) || !is_published) return;
  for (const mqtt::Message& message : messages) published_[message.topic] = message.payload;
}

}  // namespace recald::daemon
