/// Writes what comes into a gateway to a file, so that it can be replayed.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <span>
#include <string>

#include "adapters/ports/store.hpp"
#include "adapters/system/files/growing_file.hpp"
#include "daemon/gateway/ingest/month_keeper.hpp"
#include "daemon/gateway/recording/line.hpp"
#include "daemon/site/config/site_config.hpp"

namespace recald::daemon::recording {

/// What a recording begins with, besides the meters.
struct Beginning {
  std::filesystem::path site_file;
  std::string program;  ///< Version.
  std::string time_zone_release;
};

class Recorder final : public Listener {
 public:
  /// Called once, if the recording ends before the gateway does. @param why  A sentence.
  using OnEnd = std::function<void(const std::string& why)>;

  /// Creates the file; one that exists is never written over.
  /// @param limit_bytes  The recording ends before it becomes larger.
  /// @return or io_failed.
  [[nodiscard]] static Result<std::unique_ptr<Recorder>> create(const std::filesystem::path& file,
                                                                std::uint64_t limit_bytes,
                                                                OnEnd on_end);

  /// Writes the site and what the store has of its meters. Call it between opening a gateway and
  /// starting it.
  /// Nothing is recorded before.
  /// @return or why the site or the store cannot be read; then nothing more is recorded.
  [[nodiscard]] Result<void> begin(const Beginning& beginning, Store& store,
                                   const metering::LocalCalendar& calendar,
                                   std::span<const StoredMeter> meters);

  void entered(const Entry& entry) override;
  void reloaded(const Entry& at, const SiteConfig& site) override;
  void stored(const std::string& meter, const metering::Reading& reading) override;

  /// Writes the last line. @param why  Of the gateway's end.
  void end(const std::string& why);

 private:
  Recorder(system::GrowingFile file, std::uint64_t limit_bytes, OnEnd on_end)
      : file_(std::move(file)), limit_bytes_(limit_bytes), on_end_(std::move(on_end)) {}

  [[nodiscard]] Result<void> write_site(const std::filesystem::path& file);
  void write(const Line& line);
  void write_stored();
  void give_up(const std::string& why);

  system::GrowingFile file_;
  std::uint64_t limit_bytes_;
  OnEnd on_end_;
  Committed stored_;  ///< Not yet written: intervals of one meter are committed together.
  bool is_on_ = false;
};

}  // namespace recald::daemon::recording
