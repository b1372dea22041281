#include "daemon/gateway/run/service.hpp"

#include <utility>  // Boost 1.74's Asio uses std::exchange without it

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <malloc.h>
#include <spdlog/spdlog.h>

#include <array>
#include <boost/asio/awaitable.hpp>
#include <boost/asio/co_spawn.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/posix/stream_descriptor.hpp>
#include <boost/asio/use_awaitable.hpp>
#include <csignal>
#include <cstdlib>
#include <random>

#include "adapters/asio/asio_loop.hpp"
#include "adapters/asio/rethrown.hpp"
#include "adapters/http/credentials.hpp"
#include "adapters/http/server.hpp"
#include "adapters/modbus/bus_thread.hpp"
#include "adapters/modbus/register_server.hpp"
#include "adapters/system/clock_setting.hpp"
#include "adapters/system/time_zone_release.hpp"
#include "adapters/system/worker_thread.hpp"
#include "daemon/gateway/alert/alerts.hpp"
#include "daemon/gateway/alert/deliver.hpp"
#include "daemon/gateway/forward/forwarding.hpp"
#include "daemon/gateway/recording/recorder.hpp"
#include "daemon/gateway/registers/register_table.hpp"
#include "daemon/gateway/registers/register_watch.hpp"
#include "daemon/gateway/run/gateway.hpp"
#include "daemon/gateway/run/job_runner.hpp"
#include "daemon/gateway/run/load_watch.hpp"
#include "daemon/gateway/run/log.hpp"
#include "daemon/gateway/run/recalibration.hpp"
#include "daemon/gateway/run/run_guarded.hpp"
#include "daemon/gateway/run/running_store.hpp"
#include "daemon/gateway/run/signals.hpp"
#include "daemon/gateway/run/site_jobs.hpp"
#include "daemon/gateway/run/watchdog.hpp"
#include "daemon/gateway/run/weather_wait.hpp"
#include "daemon/gateway/serve/site_server.hpp"
#include "daemon/gateway/upkeep/upkeep.hpp"
#include "daemon/version.hpp"

namespace recald::daemon {
namespace {

/// Checks the settings that a running process cannot change. @return or a sentence that names one.
Result<void> can_reload(const SiteConfig& now, const SiteConfig& then) {
  const auto needs_restart = [](const char* what) {
    return failure(
        ErrorCode::unsupported,
        fmt::format("a changed {} needs a restart; change it back, or restart recald", what));
  };
  if (now.id != then.id) return needs_restart("id");
  if (now.timezone != then.timezone) return needs_restart("timezone");
  if (now.closing.watermark != then.closing.watermark) return needs_restart("watermark");
  if (now.store.file != then.store.file) return needs_restart("[store] file");
  if (now.http.has_value() != then.http.has_value()) return needs_restart("[http]");
  if (now.http && now.http->certificate_file.empty() != then.http->certificate_file.empty()) {
    return needs_restart("choice of TLS");
  }
  if (now.http && (now.http->address != then.http->address || now.http->port != then.http->port)) {
    return needs_restart("[http] listen");
  }
  if (now.modbus.has_value() != then.modbus.has_value()) return needs_restart("[modbus]");
  if (now.modbus &&
      (now.modbus->address != then.modbus->address || now.modbus->port != then.modbus->port)) {
    return needs_restart("[modbus] listen");
  }
  return {};
}

/// Of the hundreds of threads most allocate a few bytes a second, so two of glibc's arenas do
/// for all; each more keeps megabytes. Long arrays, of hours of weather or readings, go back to the
/// system when they are freed: by default glibc learns from the first one to keep them.
void save_memory() {
  constexpr int kArenas = 2;
  constexpr int kLongArray_bytes = 128 * 1024;
  ::mallopt(M_ARENA_MAX, kArenas);
  ::mallopt(M_MMAP_THRESHOLD, kLongArray_bytes);
}

/// What this machine knows of the time.
ClockEvidence clock_evidence() {
  return {.released = std::chrono::sys_days{metering::parse_day(kMadeOn).value()},
          .is_settling = system::is_clock_settling,
          .is_synchronised = system::is_clock_synchronised};
}

/// For a store in memory: no backups, and no more data than memory allows.
StoreConfig upkeep_of(StoreConfig config, const RunningStore& running) {
  if (running.missing.empty()) return config;
  config.backup_at.reset();
  config.raw_kept = std::chrono::days{7};
  return config;
}

/// All parts of the process. Members are destroyed in reverse order: an object that calls another
/// one is destroyed before it.
class Service {
 public:
  /// @param opener, signals  Belong to the process; they outlive this.
  /// @param notified         What an earlier service has sent to whom.
  Service(OpenSite site, const ServiceOptions& options, RunningStore store, StoreOpener& opener,
          Signals& signals, Alerts::Notified notified)
      : site_(std::move(site)),
        shared_site_(share(site_)),
        running_(std::move(store)),
        store_(running_.store.get()),
        opener_(opener),
        signals_(signals),
        loop_(context_, options.trial),
        worker_(loop_),
        checker_(loop_),
        looker_(loop_),
        expecter_(loop_),
        options_(options),
        jobs_(
            {loop_, *store_, worker_}, make_site_work(shared_site_),
            [this](const StoredJob& job) {
              log_job(job);
              if (facts_) facts_->refresh();
            },
            [this](const StoreEvent& event) {
              gateway_->count_stored(event);
              on_event(event);
            }),
        weather_wait_({loop_, *store_, looker_}, make_weather_check(shared_site_),
                      [this] { calibrate_with_weather(); }),
        load_watch_(loop_, expecter_, make_load_expectation(shared_site_),
                    [this] { return jobs_.is_running(); }),
        upkeep_(*store_, checker_, upkeep_of(site_.config.store, running_), site_.calendar,
                [this](StoreEvent event) { gateway_->note(std::move(event)); }),
        watchdog_(loop_, [this] { return store_->events(1).has_value(); }),
        alerts_(
            {loop_, *store_, [this] { return std::make_unique<system::WorkerThread>(loop_); }},
            shared_config(), site_.calendar, deliver,
            [this](StoreEvent event) { gateway_->note(std::move(event)); }, std::move(notified)),
        forwarding_(
            {loop_, *store_, running_.missing.empty()}, shared_config(), site_.calendar,
            [this](StoreEvent event) { gateway_->note(std::move(event)); },
            [this](const MeterValue& value) { (void)gateway_->accept_mqtt(value); }) {}

  /// @param memory  What an earlier service kept in memory; may be null.
  Result<void> open(Store* memory) {
    const auto recorder = create_recorder();
    auto gateway =
        Gateway::open(site_.config, site_.calendar,
                      {.loop = loop_,
                       .store = *store_,
                       .make_bus =
                           [this](const BusConfig& bus) {
                             return std::make_unique<modbus::BusThread>(bus.endpoint, loop_);
                           },
                       .time_zone_release = system::time_zone_release(),
                       .seed = std::random_device{}(),  // only for jitter, not for results
                       .clock = options_.trial ? std::nullopt : std::optional{clock_evidence()},
                       .on_event = [this](const StoreEvent& event) { on_event(event); },
                       .recorder = recorder_.get()},
                      [this](const metering::Meter& meter, const metering::MonthlyFigure& figure) {
                        log_month(meter, figure);
                        if (facts_) facts_->refresh();
                        recalibration_->month_closed(meter.id);
                      });
    if (!gateway) return tl::unexpected(gateway.error());
    gateway_ = std::move(*gateway);
    if (memory != nullptr) {
      if (auto taken = gateway_->take_over(*memory, feed_watchdog); !taken) return taken;
    }
    if (!recorder) {
      not_recorded(recorder.error().message);
    } else if (recorder_) {
      begin_recording();
    }
    return {};
  }

  /// Serves HTTP and registers if the site is configured to.
  Result<void> listen() {
    if (const auto& modbus = site_.config.modbus) {
      registers_ = TRY(
          modbus::RegisterServer::listen({.address = modbus->address, .port = modbus->port},
                                         modbus::Words(static_cast<std::size_t>(kFirstMeterAt))));
      spdlog::info("event=listening_modbus address={} port={}", modbus->address,
                   registers_->port());
    }
    const auto& http = site_.config.http;
    if (!http) return {};
    server_ = TRY(serve_site(context_, *http, served()));
    spdlog::info("event=listening address={} port={}", http->address, server_->port());
    return {};
  }

  Result<void> run() {
    boost::asio::co_spawn(context_, heed_signals(), asio::rethrown);
    spdlog::info("event=started site={} store={}", site_.config.id,
                 site_.config.store.file.string());
    jobs_.resume();
    schedule();
    catch_up();
    forwarding_.start();
    gateway_->start();
    weather_wait_.start();
    load_watch_.start();
    report_facts();
    keep_up();
    if (!running_.missing.empty()) stand_in();
    loop_.post([this] { watchdog_.ready(); });
    run_guarded(context_, loop_, [this](StoreEvent event) { gateway_->note(std::move(event)); });
    if (!found_) watchdog_.ending();
    server_.reset();
    facts_.reset();
    registers_.reset();
    jobs_.interrupt();
    const std::string why = found_ ? "the store could be opened" : "the daemon ended";
    if (recorder_ && found_) note_recording_ended(why);
    const auto flushed = gateway_->flush();
    if (recorder_) recorder_->end(why);
    spdlog::info("event=ended");
    return flushed;
  }

  /// The site's store, after a run that ended because it can be opened.
  [[nodiscard]] std::optional<RunningStore> take_found() { return std::exchange(found_, {}); }
  /// The store with what was kept in memory.
  [[nodiscard]] std::unique_ptr<Store> take_store() { return std::move(running_.store); }
  [[nodiscard]] Alerts::Notified take_notified() { return alerts_.take_notified(); }
  [[nodiscard]] const OpenSite& site() const { return site_; }
  /// Whether the site's store is being opened on another thread; destroying this waits for it.
  [[nodiscard]] bool is_opening() const { return is_opening_; }

 private:
  [[nodiscard]] std::shared_ptr<const SiteConfig> shared_config() const {
    return {shared_site_, &shared_site_->config};
  }

  Result<void> create_recorder() {
    if (options_.record.empty()) return {};
    recorder_ = TRY(recording::Recorder::create(
        options_.record, options_.record_max_bytes, [this](const std::string& why) {
          // Posted, because the gateway is in the middle of what was to be recorded.
          loop_.post([this, why] { note_recording_ended(why); });
        }));
    return {};
  }

  void note_recording_ended(const std::string& why) {
    gateway_->note({loop_.now().instant(), Severity::warning, "recording_ended", "",
                    fmt::format("the recording '{}' has ended: {}; recald goes on without",
                                options_.record.string(), why)});
  }

  void begin_recording() {
    const auto begun = recorder_->begin({site_.config.file, kVersion, system::time_zone_release()},
                                        *store_, site_.calendar, gateway_->meters());
    if (!begun) not_recorded(begun.error().message);
  }

  void not_recorded(const std::string& why) {
    gateway_->note({loop_.now().instant(), Severity::warning, "not_recorded", "",
                    fmt::format("nothing is recorded: {}; recald goes on without", why)});
  }

  void stand_in() {
    gateway_->note(
        {.time = loop_.now().instant(),
         .severity = Severity::error,
         .kind = "no_store",
         .subject = "",
         .text = "the store cannot be opened, so readings are kept in memory until it can be: " +
                 running_.missing,
         .is_counted = true});
    look_for_store();
  }

  void look_for_store() {
    loop_.after(opener_.wait(), [this] { try_to_open(); });
  }

  /// Opens the store beside the loop, which continues to poll: a large store takes minutes, a
  /// damaged one longer. The worker has no jobs, since there is no store for them.
  void try_to_open() {
    is_opening_ = true;
    auto opened = std::make_shared<Result<stores::CheckedStore>>();
    worker_.run([this, opened, store = site_.config.store,
                 now = loop_.now().instant()] { *opened = opener_.open(store, now); },
                [this, opened] {
                  is_opening_ = false;
                  take_opened(std::move(*opened));
                });
  }

  void take_opened(Result<stores::CheckedStore> opened) {
    if (!opened) return look_for_store();
    if (!opened->recovery.empty()) {
      spdlog::error("event=store_recovered what=\"{}\"", opened->recovery);
    }
    spdlog::info("event=store_opened what=\"the readings kept in memory are moved to the store\"");
    found_ = RunningStore{std::move(opened->store), ""};
    context_.stop();
  }

  Served served() {
    return Served{.site = site_.config,
                  .calendar = site_.calendar,
                  .store = *store_,
                  .status =
                      [this] {
                        GatewayStatus status = gateway_->status();
                        status.no_store = running_.missing;
                        status.destinations = forwarding_.status();
                        return status;
                      },
                  .meter_status = [this](const auto& id) { return gateway_->meter_status(id); },
                  .now = [this] { return loop_.now().instant(); },
                  .clock_doubt = [this] { return gateway_->clock_doubt(); },
                  .started = loop_.now().instant(),
                  .no_store = running_.missing,
                  .ask_job = [this](JobKind kind) { return ask(kind, "api"); },
                  .cancel_job = [this](std::int64_t number) { return jobs_.cancel(number); },
                  .expected = [this] { return std::cref(load_watch_.latest()); },
                  .progress = [this] { return jobs_.progress(); },
                  .take_readings =
                      [this](const std::string& meter, auto readings, const auto& correction) {
                        return gateway_->take_pushed(meter, std::move(readings), correction);
                      },
                  .take_samples =
                      [this](const std::string& meter, auto samples) {
                        return gateway_->take_samples(meter, std::move(samples));
                      }};
  }

  /// For management systems and brokers, if the site has any.
  void report_facts() {
    const bool is_wanted = registers_ || (site_.config.mqtt && site_.config.mqtt->publishes);
    if (!is_wanted || facts_) return;
    facts_ = std::make_unique<RegisterWatch>(loop_, served(), [this](const SiteFacts& facts) {
      if (registers_) registers_->set(register_values(facts));
      forwarding_.set_facts(facts);
    });
    facts_->start();
  }

  boost::asio::awaitable<void> heed_signals() {
    for (;;) {
      co_await signal_file_.async_wait(boost::asio::posix::stream_descriptor::wait_read,
                                       boost::asio::use_awaitable);
      const auto signal = signals_.next();
      if (!signal) continue;
      // Posted, so that the next signal is handled whatever happens here.
      if (*signal == SIGHUP) {
        loop_.post([this] { reload(); });
      } else if (*signal == SIGUSR1) {
        loop_.post([this] { calibrate("signal"); });
      } else {
        spdlog::info("event=ending signal={}", *signal);
        break;
      }
    }
    signals_.let_ends_through();  // a second one ends the process at once
    context_.stop();
  }

  void keep_up() {
    const bool is_clock_right = gateway_->clock_doubt().empty();
    loop_.after(upkeep_.maintain(loop_.now().instant(), is_clock_right), [this] { keep_up(); });
  }

  void schedule() {
    recalibration_ = std::make_unique<Recalibration>(
        loop_, site_.config, site_.calendar,
        [this](const std::string& asked_by) { calibrate(asked_by); });
    recalibration_->start();
  }

  /// Reads the site file again. If it is wrong, nothing changes except that the buses restart.
  void reload() {
    const auto changed = reload_from(site_.config.file);
    if (changed) {
      spdlog::info("event=reloaded file={}", site_.config.file.string());
      return;
    }
    gateway_->begin_buses_anew();
    gateway_->note({loop_.now().instant(), Severity::error, "not_reloaded", "",
                    "the site file was rejected, recald continues with the old one: " +
                        changed.error().message});
  }

  Result<void> reload_from(const std::filesystem::path& file) {
    auto config = load_site(file);
    if (!config)
      return failure(ErrorCode::malformed, fmt::format("{}", fmt::join(config.error(), "; ")));
    if (auto possible = can_reload(site_.config, *config); !possible) return possible;
    auto tokens = TRY(read_tokens(config->http.value_or(HttpConfig{})));
    Result<http::Tls> tls;
    if (server_ && !config->http->certificate_file.empty()) {
      tls = http::read_tls({config->http->certificate_file, config->http->key_file});
      if (!tls) return tl::unexpected(tls.error());
    }
    if (auto reloaded = gateway_->reload(*config); !reloaded) return reloaded;
    if (server_) server_->set_tokens(std::move(tokens));
    if (*tls) server_->set_tls(std::move(*tls));
    upkeep_.set_config(upkeep_of(config->store, running_));
    site_.config = std::move(*config);
    shared_site_ = share(site_);
    jobs_.set_work(make_site_work(shared_site_));
    weather_wait_.set_check(make_weather_check(shared_site_));
    load_watch_.set_expect(make_load_expectation(shared_site_));
    alerts_.set_site(shared_config());
    forwarding_.set_site(shared_config());
    report_facts();
    if (facts_) facts_->refresh();
    schedule();
    // A month that closed within the last minute would have been requested by the old schedule.
    catch_up();
    return {};
  }

  void catch_up() {
    if (const auto asked = recalibration_->catch_up(*store_, site_.config); !asked) {
      spdlog::warn("event=not_caught_up why=\"{}\"", asked.error().message);
    }
  }

  Result<std::int64_t> ask(JobKind kind, const std::string& asked_by) {
    if (!running_.missing.empty()) {
      return failure(ErrorCode::io_failed, "the store cannot be opened: " + running_.missing);
    }
    TRY(require_model(site_.config));
    return jobs_.ask(kind, asked_by);
  }

  void calibrate(const std::string& asked_by) {
    if (const auto asked = ask(JobKind::calibration, asked_by); !asked) {
      spdlog::warn("event=calibration_not_begun asked_by={} why=\"{}\"", asked_by,
                   asked.error().message);
    }
  }

  /// If the site is not calibrated automatically, nothing is calibrated again for
  /// its weather either.
  void calibrate_with_weather() {
    if (!site_.config.recalibration.schedule.is_never()) calibrate("weather");
  }

  static void log_month(const metering::Meter& meter, const metering::MonthlyFigure& figure) {
    spdlog::info(
        "event=month_closed meter={} month={} revision={} kWh_per_day={:.1f} coverage={:.3f}",
        meter.id, metering::to_string(figure.month), figure.revision, figure.daily_average_kWh,
        figure.coverage);
  }

  void on_event(const StoreEvent& event) {
    log_event(event);
    alerts_.observe(event);
  }

  static void log_event(const StoreEvent& event) {
    constexpr std::array kLevels{spdlog::level::info, spdlog::level::warn, spdlog::level::err};
    spdlog::log(kLevels.at(static_cast<std::size_t>(event.severity)),
                "event={} subject={} what=\"{}\"", event.kind, event.subject, event.text);
  }

  static void log_job(const StoredJob& job) {
    const auto level = job.state == JobState::failed ? spdlog::level::warn : spdlog::level::info;
    spdlog::log(
        level, "event=job number={} kind={} state={} asked_by={} accepted={} message=\"{}\"",
        job.number, name_of(job.kind), name_of(job.state), job.asked_by, job.accepted, job.message);
  }

  OpenSite site_;
  SharedSite shared_site_;  ///< For work on other threads; a reload does not change it.
  RunningStore running_;
  Store* store_;  ///< From `running_`.
  StoreOpener& opener_;
  Signals& signals_;
  bool is_opening_ = false;
  std::optional<RunningStore> found_;
  boost::asio::io_context context_{1};
  boost::asio::posix::stream_descriptor signal_file_{context_, signals_.descriptor()};
  asio::AsioLoop loop_;
  system::WorkerThread worker_;
  system::WorkerThread checker_;   ///< For backups.
  system::WorkerThread looker_;    ///< For weather checks.
  system::WorkerThread expecter_;  ///< For what the model expects of the meters.
  ServiceOptions options_;
  JobRunner jobs_;  ///< Tells its work to stop before the worker waits for it.
  WeatherWait weather_wait_;
  LoadWatch load_watch_;
  std::unique_ptr<Recalibration> recalibration_;
  Upkeep upkeep_;
  Watchdog watchdog_;
  Alerts alerts_;
  Forwarding forwarding_;
  std::unique_ptr<recording::Recorder> recorder_;  ///< Null: none is asked for, or possible.
  std::unique_ptr<Gateway> gateway_;
  std::unique_ptr<http::Server> server_;
  std::unique_ptr<modbus::RegisterServer> registers_;
  std::unique_ptr<RegisterWatch> facts_;
};

/// Opening may take minutes more. It can be killed at any step, so do not wait for it.
[[noreturn]] void leave_at_once(const Result<void>& ended) {
  std::_Exit(ended ? EXIT_SUCCESS : EXIT_FAILURE);
}

}  // namespace

Result<void> run_service(OpenSite site, const ServiceOptions& options) {
  save_memory();
  open_log();
  auto signals = TRY(Signals::open());
  StoreOpener opener;
  const auto now = std::chrono::floor<std::chrono::seconds>(std::chrono::system_clock::now());
  auto store = open_running_store(opener, site.config.store, now, extend_start);
  if (!store) return tl::unexpected(store.error());
  signals.hold_ends();
  Alerts::Notified notified;
  ServiceOptions now_options = options;
  for (std::unique_ptr<Store> memory;; now_options.record.clear()) {  // one service is recorded
    auto service = std::make_unique<Service>(std::move(site), now_options, std::move(*store),
                                             opener, signals, std::exchange(notified, {}));
    if (auto opened = service->open(memory.get()); !opened) {
      if (!memory) return opened;
      // The readings in memory exist nowhere else: continue with them, and try again later.
      spdlog::error("event=not_taken_over why=\"{}\"", opened.error().message);
      opener.back_off();
      site = service->site();
      notified = service->take_notified();
      store = RunningStore{std::move(memory), opened.error().message};
      continue;
    }
    memory.reset();
    if (auto listening = service->listen(); !listening) return listening;
    auto ended = service->run();
    auto found = service->take_found();
    if (service->is_opening()) leave_at_once(ended);
    if (!found) return ended;
    site = service->site();
    notified = service->take_notified();
    memory = service->take_store();
    store = std::move(*found);
  }
}

}  // namespace recald::daemon
