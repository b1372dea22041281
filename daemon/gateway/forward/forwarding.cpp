#include "daemon/gateway/forward/forwarding.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "adapters/http/credentials.hpp"
#include "adapters/http/url.hpp"
#include "adapters/system/sha256.hpp"
#include "adapters/system/worker_thread.hpp"
#include "daemon/gateway/forward/mqtt_messages.hpp"
#include "daemon/gateway/forward/sinks.hpp"

namespace recald::daemon {
namespace {

constexpr std::chrono::milliseconds kGoodbyeMax{1'000};
constexpr std::chrono::minutes kRefusalsEvery{10};

/// An address may hold a secret, so it is not part of the name as it is.
std::string hashed(std::string_view kind, const std::string& what) {
  system::Sha256 digest;
  digest.add(what);
  return fmt::format("{} {}", kind, digest.hex().substr(0, 16));
}

Destination destination_of(const RemoteWriteConfig& config) {
  const bool is_influx = config.protocol == WriteProtocol::influx;
  const auto url = http::parse_url(config.url);
  return {.id = hashed(is_influx ? "influx" : "prometheus", config.url),
          .words = fmt::format("{} at {}", is_influx ? "InfluxDB" : "Prometheus",
                               url ? url->authority() : "?")};
}

std::string broker_words(const MqttConfig& config) { return "MQTT broker at " + config.where(); }

Destination destination_of(const MqttConfig& config) {
  return {.id = hashed("mqtt", config.where() + " " + config.topic),
          .words = broker_words(config),
          .wants_events = true};
}

Result<mqtt::Broker> broker_of(const MqttConfig& config) {
  mqtt::Broker broker{.host = config.host,
                      .port = config.port,
                      .is_tls = config.is_tls,
                      .client_id = config.client_id,
                      .user = config.login.user,
                      .password = {},
                      .trusted_certificate = config.trusted_certificate,
                      .certificate_file = config.certificate_file,
                      .key_file = config.key_file};
  if (config.login.user.empty()) return broker;
  auto password = http::read_password_file(config.login.password_file);
  if (!password) return tl::unexpected(password.error());
  broker.password = std::move(*password);
  return broker;
}

mqtt::Session session_of(const SiteConfig& site) {
  mqtt::Session session{.will = {}, .birth = {}, .topics = told_topics(site)};
  if (site.mqtt->publishes) {
    session.will = presence_message(site, false);
    session.birth = presence_message(site, true);
  }
  return session;
}

}  // namespace

Forwarding::Forwarding(Ports ports, std::shared_ptr<const SiteConfig> site,
                       metering::LocalCalendar calendar, Tell tell, OnValue on_value)
    : ports_(ports),
      site_(std::move(site)),
      calendar_(std::move(calendar)),
      tell_(std::move(tell)),
      on_value_(std::move(on_value)),
      self_(std::make_shared<Forwarding*>(this)) {}

Forwarding::~Forwarding() {
  self_.reset();
  state_.reset();  // first: others wait for what it publishes
  forwarders_.clear();
  if (!link_ || !link_->is_connected() || !site_->mqtt->publishes) return;
  // A connection that ends well leaves no will behind.
  (void)link_->publish(std::vector{presence_message(*site_, false)}, kGoodbyeMax, {});
}

void Forwarding::start() {
  is_started_ = true;
  begin();
}

void Forwarding::set_site(std::shared_ptr<const SiteConfig> site) {
  const bool is_same_connection =
      site_->mqtt == site->mqtt && told_topics(*site_) == told_topics(*site);
  site_ = std::move(site);
  if (!is_started_) return;
  state_.reset();
  forwarders_.clear();
  // The session of a name has one owner. One that was refused may have another password by now.
  if (!is_same_connection || (link_ && !link_->is_connected())) link_.reset();
  begin();
}

void Forwarding::begin() {
  if (site_->mqtt && !link_) {
    connect();
    if (link_) forwarders_.clear();  // the one that had no link
  }
  if (link_ && site_->mqtt->publishes && !state_) {
    state_ = std::make_unique<BrokerState>(
        ports_.loop, std::make_unique<system::WorkerThread>(ports_.loop), site_, link_);
  }
  keep_outbox();
}

/// Without its password, say: the reason may go away by itself.
void Forwarding::begin_again_in_a_minute() {
  if (std::exchange(is_again_due_, true)) return;
  ports_.loop.after(std::chrono::minutes{1}, [weak = std::weak_ptr{self_}] {
    const auto self = weak.lock();
    if (!self) return;
    (*self)->is_again_due_ = false;
    (*self)->begin();
  });
}

void Forwarding::connect() {
  if (!site_->mqtt || link_) return;
  const auto broker = broker_of(*site_->mqtt);
  // Both are called on the connection's thread.
  auto opened =
      !broker ? tl::unexpected(broker.error())
              : mqtt::Connection::open(
                    *broker, session_of(*site_),
                    [&loop = ports_.loop, weak = std::weak_ptr{self_}](const mqtt::Message& one) {
                      loop.post([weak, one] {
                        if (const auto self = weak.lock()) (*self)->hear(one);
                      });
                    },
                    [&loop = ports_.loop, weak = std::weak_ptr{self_}](bool is_connected,
                                                                       const std::string& why) {
                      loop.post([weak, is_connected, why] {
                        if (const auto self = weak.lock()) (*self)->hear_state(is_connected, why);
                      });
                    });
  if (!opened) {
    hear_state(false, opened.error().message);
    return begin_again_in_a_minute();
  }
  link_ = std::make_shared<BrokerLink>(std::move(*opened));
}

void Forwarding::hear(const mqtt::Message& message) {
  const ToldMessage told = read_told(*site_, message.topic, message.payload, message.is_retained,
                                     ports_.loop.now().instant());
  for (const ToldValue& value : told.values) on_value_(value);
  const auto now = ports_.loop.now().monotonic;
  for (const ToldRefusal& refusal : told.refusals) {
    // Whoever sends nonsense ten times a second does not have it stored as often.
    const auto known = refused_at_.find(refusal.meter);
    if (known != refused_at_.end() && now - known->second < kRefusalsEvery) continue;
    refused_at_[refusal.meter] = now;
    tell(Severity::warning, "message_refused", refusal.meter, refusal.why);
  }
}

void Forwarding::hear_state(bool is_connected, const std::string& why) {
  if (!site_->mqtt) return;
  const std::string words = broker_words(*site_->mqtt);
  if (!is_connected) {
    // Of an attempt each minute, once.
    if (std::exchange(is_broker_lost_, true) && why == lost_why_) return;
    lost_why_ = why;
    tell(Severity::warning, "broker_lost", words,
         fmt::format("the {} is not connected: {}; recald keeps trying", words, why));
    return;
  }
  if (!why.empty()) {  // connected, and something was refused or dropped
    return tell(Severity::warning, "broker_refuses", words, why);
  }
  if (state_) state_->begin_anew();
  if (std::exchange(is_broker_lost_, false)) {
    tell(Severity::info, "broker_found", words, fmt::format("the {} is connected again", words));
  }
}

/// A destination that is not reached yet is one: it is told later.
void Forwarding::keep_outbox() {
  if (!ports_.is_on_disk) return;
  std::vector<std::string> ids;
  if (site_->mqtt && site_->mqtt->publishes) ids.push_back(destination_of(*site_->mqtt).id);
  for (const RemoteWriteConfig& write : site_->remote_writes) {
    ids.push_back(destination_of(write).id);
  }
  if (!ports_.store.keep_outbox_for(ids)) return begin_again_in_a_minute();
  const auto add = [&](Destination destination, std::unique_ptr<Sink> sink) {
    // Twice in the file is once: there is one position.
    const bool is_there = std::ranges::any_of(
        forwarders_, [&](const auto& one) { return one->destination().id == destination.id; });
    if (is_there) return;
    forwarders_.push_back(
        std::make_unique<Forwarder>(Forwarder::Ports{ports_.loop, ports_.store},
                                    std::make_unique<system::WorkerThread>(ports_.loop),
                                    std::move(destination), std::move(sink), tell_));
    forwarders_.back()->start();
  };
  if (site_->mqtt && site_->mqtt->publishes) {
    add(destination_of(*site_->mqtt), make_mqtt_sink(site_, link_));
  }
  for (const RemoteWriteConfig& write : site_->remote_writes) {
    add(destination_of(write), make_series_sink(site_, calendar_, write));
  }
}

std::vector<DestinationStatus> Forwarding::status() const {
  std::vector<DestinationStatus> all;
  for (const auto& forwarder : forwarders_) all.push_back(forwarder->status());
  return all;
}

void Forwarding::tell(Severity severity, const char* kind, const std::string& subject,
                      std::string text) {
  tell_({.time = ports_.loop.now().instant(),
         .severity = severity,
         .kind = kind,
         .subject = subject,
         .text = std::move(text),
         .is_counted = true});
}

}  // namespace recald::daemon
