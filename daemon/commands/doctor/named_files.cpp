#include <fmt/format.h>

#include <algorithm>
#include <regex>
#include <set>
#include <variant>

#include "adapters/system/machine.hpp"
#include "daemon/commands/doctor/facts.hpp"
#include "daemon/site/setup/site_file.hpp"

namespace recald::daemon {
namespace {

namespace fs = std::filesystem;

/// Opens what it is told to, each file once, and keeps what came of it.
class OpenedFiles {
 public:
  explicit OpenedFiles(const SiteConfig& site) : folder_(fs::absolute(site.file).parent_path()) {}

  /// @param what  "readings"
  void read(std::string_view what, const fs::path& file) {
    if (file.empty() || !seen_.insert(file).second) return;
    std::error_code ignored;
    const std::string why = system::why_unreadable(file);
    const auto bytes = static_cast<double>(why.empty() ? fs::file_size(file, ignored) : 0);
    add(what, file, why.empty() ? "can be read, " + size_words(bytes) : "cannot be read", why,
        "put it there, or name another one");
  }

  /// @param is_needed  Whether something that was asked for cannot be done without.
  void write(std::string_view what, const fs::path& folder, bool is_needed) {
    if (folder.empty() || !seen_.insert(folder).second) return;
    const std::string why = system::why_unwritable(folder);
    add(what, folder, why.empty() ? "can be written" : "cannot be written", why,
        "give the daemon's user the right to write there");
    facts_.back().stops_work = !why.empty() && is_needed;
  }

  [[nodiscard]] std::vector<Fact> take() { return std::move(facts_); }

 private:
  void add(std::string_view what, const fs::path& path, std::string value, const std::string& why,
           std::string_view advice) {
    Fact fact{fmt::format("{} {}", what, relative_path(path, folder_)), std::move(value)};
    if (!why.empty()) {
      fact.problem = fmt::format("{} {}; {}", path.string(), why, advice);
      fact.stops_work = true;
    }
    facts_.push_back(std::move(fact));
  }

  fs::path folder_;
  std::set<fs::path> seen_;
  std::vector<Fact> facts_;
};

/// A map of the site's own, which its [[meter]] names; empty: a shipped one.
fs::path own_map(const SiteConfig& site, const MeterConfig& meter) {
  static const std::regex named{R"re(map\s*=\s*["']([^"']+\.toml)["'])re"};
  std::smatch found;
  if (!meter.live || !std::regex_search(meter.text, found, named)) return {};
  return site.file.parent_path() / found[1].str();
}

void open_meters(const SiteConfig& site, OpenedFiles& files) {
  for (const auto* const list : {&site.meters, &site.sensors}) {
    for (const MeterConfig& meter : *list) {
      for (const fs::path& file : meter.files) files.read("readings", file);
      files.read("register map", own_map(site, meter));
    }
  }
  if (!site.weather) return;
  for (const fs::path& file : site.weather->files) files.read("weather", file);
}

void open_models(const SiteConfig& site, OpenedFiles& files) {
  std::vector<const ModelConfig*> models;
  if (site.model) models.push_back(&*site.model);
  for (const ModelConfig& model : site.other_models) models.push_back(&model);
  for (const ModelConfig* model : models) {
    if (!model->energyplus) continue;
    files.read("EnergyPlus model", model->energyplus->file);
    files.read("EnergyPlus", model->energyplus->program);
    files.write("design", model->energyplus->design, true);
  }
  const fs::path& design = site.recalibration.design;
  if (!design.empty()) files.read("design", design / "doe_outputs.csv");
}

void open_certificates(const SiteConfig& site, OpenedFiles& files) {
  const auto open_broker = [&](const BrokerConfig& broker) {
    files.read("trusted certificate", broker.trusted_certificate);
    files.read("certificate", broker.certificate_file);
    files.read("key", broker.key_file);
  };
  if (site.mqtt) open_broker(site.mqtt->broker);
  if (site.fleet) open_broker(*site.fleet);
  for (const RemoteWriteConfig& write : site.remote_writes) {
    files.read("trusted certificate", write.trusted_certificate);
  }
  for (const AlertDestination& one : site.alerts.destinations) {
    std::visit(
        [&](const auto& destination) {
          if constexpr (requires { destination.trusted_certificate; }) {
            files.read("trusted certificate", destination.trusted_certificate);
          }
        },
        one);
  }
}

}  // namespace

std::vector<Fact> named_files(const SiteConfig& site) {
  OpenedFiles files{site};
  open_meters(site, files);
  open_models(site, files);
  open_certificates(site, files);
  // A site whose meters are all in files may have its store nowhere.
  const bool has_daemon = std::ranges::any_of(site.meters, &MeterConfig::is_stored);
  files.write("store's folder", fs::absolute(site.store.file).parent_path(), has_daemon);
  if (site.store.backup_at) {
    files.write("backups' folder", fs::absolute(site.store.backup_folder), has_daemon);
  }
  return files.take();
}

}  // namespace recald::daemon
