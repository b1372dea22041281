#include "daemon/gateway/forward/sinks.hpp"

#include <utility>

#include "adapters/http/credentials.hpp"
#include "adapters/series/writing.hpp"
#include "daemon/gateway/forward/mqtt_messages.hpp"
#include "daemon/gateway/forward/series_points.hpp"

namespace recald::daemon {
namespace {

constexpr std::chrono::seconds kPublishMax{30};

Sent later(std::string why) { return {.outcome = Sent::Outcome::later, .why = std::move(why)}; }

/// Address and secrets, without a body.
Result<delivery::Post> post_to(const RemoteWriteConfig& config) {
  delivery::Post post{.url = config.url,
                      .token = {},
                      .user = config.login.user,
                      .password = {},
                      .trusted_certificate = config.trusted_certificate,
                      .content_type = {},
                      .headers = {},
                      .body = {}};
  if (!config.token_file.empty()) {
    post.token = TRY(http::read_token_file(config.token_file));
  }
  if (!config.login.user.empty()) {
    post.password = TRY(http::read_password_file(config.login.password_file));
  }
  return post;
}

class SeriesSink final : public Sink {
 public:
  SeriesSink(std::shared_ptr<const SiteConfig> site, metering::LocalCalendar calendar,
             RemoteWriteConfig config)
      : site_(std::move(site)), calendar_(std::move(calendar)), config_(std::move(config)) {}

  Sent send(const OutgoingBatch& batch, const std::stop_token& stop) override {
    auto to = post_to(config_);
    if (!to) return later(to.error().message);
    const auto protocol = config_.protocol == WriteProtocol::influx
                              ? series::Protocol::influx
                              : series::Protocol::remote_write;
    const auto points = series_points(*site_, calendar_, batch);
    const auto answer = delivery::post(series::message(protocol, std::move(*to), points), stop);
    if (!answer) return later(answer.error().message);
    series::Meaning meaning = series::meaning_of(*answer);
    return {.outcome = outcome_of(meaning.outcome),
            .why = std::move(meaning.why),
            .wait = meaning.wait};
  }

 private:
  static Sent::Outcome outcome_of(series::Outcome outcome) {
    switch (outcome) {
      case series::Outcome::taken:
        return Sent::Outcome::taken;
      case series::Outcome::partly:
        return Sent::Outcome::partly;
      case series::Outcome::refused:
        return Sent::Outcome::refused;
      case series::Outcome::later:
        break;
    }
    return Sent::Outcome::later;
  }

  std::shared_ptr<const SiteConfig> site_;
  metering::LocalCalendar calendar_;
  RemoteWriteConfig config_;
};

class MqttSink final : public Sink {
 public:
  MqttSink(std::shared_ptr<const SiteConfig> site, std::shared_ptr<BrokerLink> link)
      : site_(std::move(site)), link_(std::move(link)) {}

  Sent send(const OutgoingBatch& batch, const std::stop_token& stop) override {
    if (!link_) return later("it is not connected");
    auto messages = mqtt_messages(*site_, batch);
    // A broker that refuses this one refuses all of them.
    if (batch.size() == 0) messages.push_back(presence_message(*site_, true));
    const auto sent = link_->publish(messages, kPublishMax, stop);
    if (sent) return {};
    // Too long, no topic, or not allowed.
    const ErrorCode code = sent.error().code;
    const bool is_later = code == ErrorCode::io_failed || code == ErrorCode::cancelled;
    return {.outcome = is_later ? Sent::Outcome::later : Sent::Outcome::refused,
            .why = sent.error().message};
  }

 private:
  std::shared_ptr<const SiteConfig> site_;
  std::shared_ptr<BrokerLink> link_;
};

}  // namespace

std::unique_ptr<Sink> make_series_sink(std::shared_ptr<const SiteConfig> site,
                                       const metering::LocalCalendar& calendar,
                                       const RemoteWriteConfig& config) {
  return std::make_unique<SeriesSink>(std::move(site), calendar, config);
}

std::unique_ptr<Sink> make_mqtt_sink(std::shared_ptr<const SiteConfig> site,
                                     std::shared_ptr<BrokerLink> link) {
  return std::make_unique<MqttSink>(std::move(site), std::move(link));
}

}  // namespace recald::daemon
