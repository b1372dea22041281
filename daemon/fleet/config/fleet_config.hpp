/// What a worker of a fleet needs to know, as its TOML file says it.
#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "daemon/site/config/service/broker_config.hpp"
#include "daemon/site/config/service/service_config.hpp"

namespace recald::daemon {

/// [record]: the database of the fleet.
struct RecordConfig {
  std::string url;  ///< "postgresql://recald@db.example.org/fleet", without a password
  std::filesystem::path password_file;  ///< Empty: none is needed, or libpq finds it itself.
};

/// [worker]
struct WorkerConfig {
  int jobs = 1;                          ///< At the same time; 0: it only takes readings in.
  std::filesystem::path folder;          ///< Where jobs work; empty: where temporary files are.
  std::chrono::seconds time_max{1'800};  ///< Of one job.
  std::uint64_t memory_max_bytes = 4'000'000'000;  ///< Of address space, of one job.
};

struct FleetConfig {
  std::filesystem::path file;
  RecordConfig record;
  std::optional<BrokerConfig> broker;  ///< Absent: a worker takes no readings in.
  WorkerConfig worker;
  std::optional<HttpConfig> http;  ///< Absent: `recald fleet serve` listens where it usually does.
};

/// Reads and checks such a file. @return every problem found.
[[nodiscard]] tl::expected<FleetConfig, std::vector<std::string>> load_fleet(
    const std::filesystem::path& file);

/// The same of a text; `file` is where paths in it start from and what messages name.
[[nodiscard]] tl::expected<FleetConfig, std::vector<std::string>> parse_fleet(
    std::string_view text, const std::filesystem::path& file);

}  // namespace recald::daemon
