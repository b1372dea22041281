#include "daemon/gateway/forward/forwarding.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "adapters/http/url.hpp"
#include "adapters/system/worker_thread.hpp"
#include "daemon/gateway/forward/mqtt_messages.hpp"
#include "daemon/gateway/forward/outbox/store_outbox.hpp"
#include "daemon/gateway/forward/record_sink.hpp"
#include "daemon/gateway/forward/sinks.hpp"
#include "daemon/site/config/weather_sensors.hpp"

namespace recald::daemon {
namespace {

constexpr std::chrono::milliseconds kGoodbyeMax{1'000};
constexpr std::chrono::minutes kRefusalsEvery{10};

Destination destination_of(const RemoteWriteConfig& config) {
  const bool is_influx = config.protocol == WriteProtocol::influx;
  const auto url = http::parse_url(config.url);
  return {.id = destination_id(is_influx ? "influx" : "prometheus", config.url),
          .words = fmt::format("{} at {}", is_influx ? "InfluxDB" : "Prometheus",
                               url ? url->authority() : "?")};
}

std::string broker_words(const MqttConfig& config) {
  return "MQTT broker at " + config.broker.where();
}

Destination destination_of(const MqttConfig& config) {
  return {.id = destination_id("mqtt", config.broker.where() + " " + config.topic),
          .words = broker_words(config),
          .wants_events = true};
}

/// A record has one broker or another: what it has received stays the same.
constexpr auto kFleet = "fleet";

/// Everything that the store may have intervals of.
std::vector<MeterInStore> stored_meters(const SiteConfig& site) {
  std::vector<MeterInStore> meters;
  for (const MeterConfig& one : site.meters) {
    if (one.is_stored()) meters.push_back({one.meter.id, one.meter.interval});
  }
  for (const MeterConfig& sensor : site.sensors) {
    if (!sensor.is_stored()) continue;
    for (const WeatherChannel& channel : channels_of(sensor)) {
      const metering::Meter meter = stored_meter(sensor, channel);
      meters.push_back({meter.id, meter.interval});
    }
  }
  return meters;
}

Destination destination_of_fleet(const SiteConfig& site) {
  return {.id = kFleet,
          .words = "fleet at " + site.fleet->where(),
          .wants_events = true,
          .wants_results = true,
          .has_identity = true,
          .history = stored_meters(site)};
}

mqtt::Session session_of(const SiteConfig& site) {
  mqtt::Session session{.will = {}, .birth = {}, .topics = meter_topics(site)};
  if (site.mqtt->publishes) {
    session.will = presence_message(site, false);
    session.birth = presence_message(site, true);
  }
  return session;
}

}  // namespace

Forwarding::Forwarding(Ports ports, std::shared_ptr<const SiteConfig> site,
                       metering::LocalCalendar calendar, Notify notify, OnValue on_value)
    : ports_(ports),
      site_(std::move(site)),
      calendar_(std::move(calendar)),
      notify_(std::move(notify)),
      on_value_(std::move(on_value)) {}

Forwarding::~Forwarding() {
  alive_ = {};     // from here on nothing that was posted is called
  state_.reset();  // first: others wait for what it publishes
  forwarders_.clear();
  fleet_.reset();
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
      site_->mqtt == site->mqtt && meter_topics(*site_) == meter_topics(*site);
  const bool is_same_fleet = site_->fleet == site->fleet;
  site_ = std::move(site);
  if (!is_started_) return;
  state_.reset();
  for (const auto& forwarder : forwarders_) forwarder->stop();
  forwarders_.clear();
  // The session of a name has one owner. One that was refused may have another password by now.
  if (!is_same_connection || (link_ && !link_->is_connected())) link_.reset();
  if (!is_same_fleet || (fleet_ && !fleet_->is_connected())) fleet_.reset();
  begin();
}

void Forwarding::begin() {
  if (site_->mqtt && !link_) {
    connect();
    if (link_) forwarders_.clear();  // the one that had no link
  }
  if (site_->fleet && !fleet_) {
    connect_to_fleet();
    if (fleet_) forwarders_.clear();
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
  ports_.loop.after(std::chrono::minutes{1}, alive_.guard([this] {
    is_again_due_ = false;
    begin();
  }));
}

void Forwarding::connect() {
  const auto hear = [messages = messages_,
                     read = on_loop(&Forwarding::read_messages)](const mqtt::Message& message) {
    if (messages->add(message)) read();
  };
  auto opened = open_broker(site_->mqtt->broker, session_of(*site_), hear,
                            on_loop(&Forwarding::on_broker_state));
  if (!opened) {
    on_broker_state(false, opened.error().message);
    return begin_again_in_a_minute();
  }
  link_ = std::make_shared<BrokerLink>(std::move(*opened));
}

void Forwarding::connect_to_fleet() {
  const auto sign = [is_due = is_sign_due_, on_record = on_loop(&Forwarding::on_record)] {
    if (!is_due->exchange(true)) on_record();
  };
  auto opened =
      RecordLink::open(*site_->fleet, site_->id, sign, on_loop(&Forwarding::on_fleet_state));
  if (!opened) {
    on_fleet_state(false, opened.error().message);
    return begin_again_in_a_minute();
  }
  fleet_ = std::move(*opened);
}

void Forwarding::read_messages() {
  for (const mqtt::Message& message : messages_->take()) read(message);
  const std::int64_t dropped = messages_->dropped();
  if (dropped == dropped_ || !site_->mqtt) return;
  notify({.time = {},
          .severity = Severity::warning,
          .kind = "messages_dropped",
          .subject = broker_words(*site_->mqtt),
          .text = fmt::format("{} messages of the MQTT broker went unread, as newer ones of their "
                              "topics came faster than they can be read",
                              dropped - dropped_),
          .is_counted = true});
  dropped_ = dropped;
}

void Forwarding::read(const mqtt::Message& message) {
  const MeterMessage parsed = parse_meter_message(*site_, message.topic, message.payload,
                                                  message.is_retained, ports_.loop.now().instant());
  for (const MeterValue& value : parsed.values) on_value_(value);
  const auto now = ports_.loop.now().monotonic;
  for (const MqttRefusal& refusal : parsed.refusals) {
    // Whoever sends nonsense ten times a second does not have it stored as often.
    const auto known = refused_at_.find(refusal.meter);
    if (known != refused_at_.end() && now - known->second < kRefusalsEvery) continue;
    refused_at_[refusal.meter] = now;
    notify({.time = {},
            .severity = Severity::warning,
            .kind = "message_refused",
            .subject = refusal.meter,
            .text = refusal.why,
            .is_counted = true});
  }
}

void Forwarding::on_broker_state(bool is_connected, const std::string& why) {
  if (!site_->mqtt) return;
  if (is_connected && why.empty() && state_) state_->begin_anew();
  auto news = broker_news_.on_state(broker_words(*site_->mqtt), is_connected, why);
  if (news) notify(std::move(*news));
}

void Forwarding::on_record() {
  is_sign_due_->store(false);
  for (const auto& forwarder : forwarders_) {
    if (forwarder->destination().id == kFleet) forwarder->try_now();
  }
}

void Forwarding::on_fleet_state(bool is_connected, const std::string& why) {
  if (!site_->fleet) return;
  const std::string words = "broker of the fleet at " + site_->fleet->where();
  if (auto news = fleet_news_.on_state(words, is_connected, why)) notify(std::move(*news));
}

/// A destination that is not reached yet is one: it is sent everything later.
void Forwarding::keep_outbox() {
  if (!ports_.is_on_disk) return;
  std::vector<std::string> ids;
  if (site_->mqtt && site_->mqtt->publishes) ids.push_back(destination_of(*site_->mqtt).id);
  for (const RemoteWriteConfig& write : site_->remote_writes) {
    ids.push_back(destination_of(write).id);
  }
  if (site_->fleet) ids.emplace_back(kFleet);
  if (!ports_.store.keep_outbox_for(ids)) return begin_again_in_a_minute();
  if (site_->mqtt && site_->mqtt->publishes) {
    add_forwarder(destination_of(*site_->mqtt), make_mqtt_sink(site_, link_));
  }
  for (const RemoteWriteConfig& write : site_->remote_writes) {
    add_forwarder(destination_of(write), make_series_sink(site_, calendar_, write));
  }
  if (!site_->fleet) return;
  add_forwarder(destination_of_fleet(*site_), make_record_sink(site_->id, fleet_));
}

void Forwarding::add_forwarder(Destination destination, std::unique_ptr<Sink> sink) {
  // Twice in the file is once: there is one position.
  const bool is_there = std::ranges::any_of(
      forwarders_, [&](const auto& one) { return one->destination().id == destination.id; });
  if (is_there) return;
  auto outbox = std::make_unique<StoreOutbox>(StoreOutbox::Ports{ports_.loop, ports_.store},
                                              std::move(destination), notify_);
  forwarders_.push_back(
      std::make_unique<Forwarder>(ports_.loop, std::make_unique<system::WorkerThread>(ports_.loop),
                                  std::move(outbox), std::move(sink), ports_.rules));
  forwarders_.back()->poll_within(std::chrono::milliseconds{0});
}

std::vector<DestinationStatus> Forwarding::status() const {
  std::vector<DestinationStatus> all;
  for (const auto& forwarder : forwarders_) all.push_back(forwarder->status());
  return all;
}

void Forwarding::notify(StoreEvent event) {
  event.time = ports_.loop.now().instant();
  notify_(std::move(event));
}

}  // namespace recald::daemon
