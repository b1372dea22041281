/// The record of a fleet, played by a test at a real broker: takes batches as the real one does.
#pragma once

#include <algorithm>
#include <condition_variable>
#include <deque>
#include <map>
#include <memory>
#include <mutex>
#include <stdexcept>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "adapters/mqtt/connection.hpp"
#include "adapters/record/record_batch.hpp"
#include "tests/support/background_process.hpp"

namespace recald::testing {

class PlayedRecord {
 public:
  /// What it has of a site.
  struct Taken {
    record::Watermark watermark;
    std::vector<OutboxEntry> entries;
    std::vector<StoreEvent> events;
    std::vector<StoredJob> results;
  };
  enum class Mood {
    takes,  ///< And says so.
    mute,   ///< Takes, and says nothing.
    away,   ///< Its database is: what comes is lost.
  };

  /// Returns when it has connected.
  explicit PlayedRecord(std::uint16_t port, Mood mood = Mood::takes)
      : PlayedRecord{port, "", "", mood} {}
  PlayedRecord(std::uint16_t port, const std::string& user, const std::string& password,
               Mood mood = Mood::takes)
      : mood_{mood} {
    mqtt::Broker broker;
    broker.host = "127.0.0.1";
    broker.port = port;
    broker.client_id = "record";
    broker.user = user;
    broker.password = password;
    auto opened = mqtt::Connection::open(
        broker, {.will = {}, .birth = {}, .topics = {"recald/v1/+/batch"}},
        [this](const mqtt::Message& message) { order({message}); },
        [this](bool is_connected, const std::string&) {
          if (is_connected) order({});
        });
    if (!opened) throw std::runtime_error(opened.error().message);
    connection_ = std::move(*opened);
    thread_ = std::jthread{[this](const std::stop_token& stop) { serve(stop); }};
    if (!is_soon_connected()) throw std::runtime_error("the record does not reach the broker");
  }

  [[nodiscard]] bool is_soon_connected() const {
    return eventually([this] { return connection_->is_connected(); });
  }

  /// One that comes back says how far it is.
  void set(Mood mood) {
    {
      const std::scoped_lock lock{mutex_};
      mood_ = mood;
    }
    if (mood == Mood::takes) order({});
  }

  /// As when a backup of it is restored: of a site it has what it had then.
  void go_back(const std::string& site, const Taken& then) {
    const std::scoped_lock lock{mutex_};
    taken_[site] = then;
  }

  [[nodiscard]] Taken of(const std::string& site) const {
    const std::scoped_lock lock{mutex_};
    const auto found = taken_.find(site);
    return found == taken_.end() ? Taken{} : found->second;
  }
  /// The mean powers of the intervals that it has, in order of arrival.
  [[nodiscard]] std::vector<double> means_of(const std::string& site) const {
    std::vector<double> means;
    for (const OutboxEntry& entry : of(site).entries) {
      const auto* const interval = std::get_if<StoredInterval>(&entry.stored);
      if (interval != nullptr) means.push_back(interval->reading.mean_kW);
    }
    return means;
  }
  /// All that has arrived, as it came.
  [[nodiscard]] std::vector<std::string> payloads() const {
    const std::scoped_lock lock{mutex_};
    return payloads_;
  }

 private:
  /// @param message  Empty: says how far it is.
  void order(const mqtt::Message& message) {
    const std::scoped_lock lock{mutex_};
    orders_.push_back(message);
    ordered_.notify_all();
  }

  void serve(const std::stop_token& stop) {
    std::unique_lock lock{mutex_};
    while (ordered_.wait(lock, stop, [this] { return !orders_.empty(); })) {
      const mqtt::Message message = std::move(orders_.front());
      orders_.pop_front();
      const bool is_asked = !message.topic.empty();
      if (is_asked) take(message);
      if (mood_ != Mood::takes) continue;
      std::vector<mqtt::Message> watermarks;
      for (auto& [site, taken] : taken_) {
        if (!is_asked) taken.watermark.answers = 0;
        watermarks.push_back({.topic = record::watermark_topic(site),
                              .payload = record::to_json(taken.watermark),
                              .is_retained = true});
      }
      lock.unlock();
      // A connection that is lost says so again when it is made again.
      (void)connection_->publish(watermarks, std::chrono::seconds{10}, stop);
      lock.lock();
    }
  }

  void take(const mqtt::Message& message) {
    payloads_.push_back(message.payload);
    const auto batch = record::parse_batch(message.payload);
    if (!batch) throw std::runtime_error(batch.error().message);
    if (mood_ == Mood::away) return;
    Taken& taken = taken_[record::site_of_topic(message.topic)];
    record::Progress& until = taken.watermark.until;
    if (taken.watermark.outbox != batch->outbox) {
      taken.watermark = {.outbox = batch->outbox, .until = {}};
      if (batch->is_first) until = batch->after;
    }
    taken.watermark.answers = batch->question;
    const record::Progress& after = batch->after;
    const bool is_behind = after.entries > until.entries || after.events > until.events ||
                           after.results > until.results;
    if (is_behind) return;
    add(batch->entries, taken.entries, until.entries);
    add(batch->events, taken.events, until.events);
    add(batch->results, taken.results, until.results);
  }
  template <class T>
  static void add(const std::vector<T>& from, std::vector<T>& to, std::int64_t& until) {
    for (const T& one : from) {
      if (one.number <= until) continue;
      to.push_back(one);
      until = one.number;
    }
  }

  mutable std::mutex mutex_;
  std::condition_variable_any ordered_;
  Mood mood_;
  std::deque<mqtt::Message> orders_;
  std::map<std::string, Taken> taken_;
  std::vector<std::string> payloads_;
  std::unique_ptr<mqtt::Connection> connection_;
  std::jthread thread_;  ///< Last: it uses all of the above.
};

}  // namespace recald::testing
