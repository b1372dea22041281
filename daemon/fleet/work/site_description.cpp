#include "daemon/fleet/work/site_description.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "adapters/system/files/read_file.hpp"
#include "adapters/toml/toml_reader.hpp"

namespace recald::daemon {
namespace {

namespace fs = std::filesystem;

/// A register map of one's own is named by the file that it is in.
void add_map(const MeterConfig& meter, const fs::path& folder, std::vector<fs::path>& paths) {
  if (!meter.live) return;
  const toml::table table = parse_toml(meter.text);
  const auto name = table["map"].value<std::string>();
  if (name && name->ends_with(".toml")) paths.push_back(folder / *name);
}

void add_model(const ModelConfig& model, std::vector<fs::path>& paths) {
  if (!model.energyplus) return;
  paths.push_back(model.energyplus->file);
  paths.push_back(model.energyplus->design);
}

/// Files and folders that the site file names for its model.
std::vector<fs::path> named_paths(const SiteConfig& site) {
  std::vector<fs::path> paths{site.file};
  const fs::path folder = site.file.parent_path();
  for (const auto* const list : {&site.meters, &site.sensors}) {
    for (const MeterConfig& meter : *list) {
      paths.insert(paths.end(), meter.files.begin(), meter.files.end());
      add_map(meter, folder, paths);
    }
  }
  if (site.weather) {
    paths.insert(paths.end(), site.weather->files.begin(), site.weather->files.end());
  }
  if (site.model) add_model(*site.model, paths);
  for (const ModelConfig& model : site.other_models) add_model(model, paths);
  if (!site.recalibration.design.empty()) paths.push_back(site.recalibration.design);
  return paths;
}

Result<void> add_file(const fs::path& file, const fs::path& folder,
                      record::SiteDescription& description) {
  const std::string name = file.lexically_relative(folder).generic_string();
  const auto is_outside = [](const std::string& path) {
    return path.empty() || path == ".." || path.starts_with("../");
  };
  std::error_code ignored;
  const std::string real = fs::weakly_canonical(file, ignored)
                               .lexically_relative(fs::weakly_canonical(folder, ignored))
                               .generic_string();
  if (!is_outside(name) && is_outside(real)) {
    return failure(
        ErrorCode::invalid_value,
        fmt::format("'{}' is a link, or lies behind one, that leads out of the folder of "
                    "the site file; put the file itself there",
                    name));
  }
  if (is_outside(name)) {
    return failure(
        ErrorCode::invalid_value,
        fmt::format("'{}' lies outside the folder of the site file, so workers elsewhere "
                    "would not find it; put it beside the site file",
                    file.string()));
  }
  description.files[name] = TRY(system::read_file(file));
  return {};
}

/// A design is a folder, which may not be there yet.
Result<void> add_path(const fs::path& path, const fs::path& folder,
                      record::SiteDescription& description) {
  std::error_code ignored;
  if (!fs::is_directory(path, ignored)) {
    const bool is_file = path.has_extension() || fs::is_regular_file(path, ignored);
    return is_file ? add_file(path, folder, description) : Result<void>{};
  }
  for (const auto& entry : fs::recursive_directory_iterator{path, ignored}) {
    if (entry.is_symlink(ignored) && entry.is_directory(ignored)) {
      return failure(ErrorCode::invalid_value,
                     fmt::format("'{}' is a link to a folder; put the folder itself there",
                                 entry.path().string()));
    }
    if (!entry.is_regular_file(ignored)) continue;
    if (auto added = add_file(entry.path(), folder, description); !added) return added;
  }
  return {};
}

}  // namespace

Result<record::SiteDescription> describe(const OpenSite& site) {
  const SiteConfig& config = site.config;
  TRY(require_model(config));
  record::SiteDescription description{.id = config.id, .name = config.name};
  if (config.location) {
    description.latitude_deg = config.location->latitude_deg;
    description.longitude_deg = config.location->longitude_deg;
  }
  if (config.building) description.floor_area_m2 = config.building->floor_area_m2;
  description.currency = config.tariff.currency;
  description.outputs = config.without_sums(config.model->outputs);
  description.site_file = config.file.filename().generic_string();
  const fs::path folder = fs::absolute(config.file).lexically_normal().parent_path();
  for (const fs::path& path : named_paths(config)) {
    TRY(add_path(fs::absolute(path).lexically_normal(), folder, description));
  }
  return description;
}

}  // namespace recald::daemon
