#include "adapters/models/model_store.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <system_error>

#include "adapters/models/version_file.hpp"
#include "adapters/models/versions_folder.hpp"
#include "adapters/system/files/write_file.hpp"

namespace recald::models {
namespace {

namespace fs = std::filesystem;
using diagnosis::kBaseVersion;
using diagnosis::ModelVersion;
using diagnosis::short_version;
using diagnosis::VersionStatus;

constexpr std::size_t kLeastDigits = 4;
constexpr std::size_t kDigits = 64;

bool is_version_name(std::string_view text) {
  return text.size() == kDigits &&
         text.find_first_not_of("0123456789abcdef") == std::string_view::npos;
}

Error in_force_already(const std::string& version) {
  return {ErrorCode::invalid_value,
          fmt::format("version {} is in force already", short_version(version))};
}

/// Checks that the model may go back to `next` from the version in force.
Result<void> check_revert(const ModelVersion& next, const std::string& from) {
  if (next.version == from) return tl::unexpected(in_force_already(from));
  if (next.status != VersionStatus::proposed) return {};
  return failure(ErrorCode::invalid_value,
                 fmt::format("version {} was proposed and never in force; `recald model apply` "
                             "puts it in force",
                             short_version(next.version)));
}

/// Returns an empty text if the file is absent.
Result<std::string> text_of(const fs::path& file) {
  std::error_code error;
  if (!fs::exists(file, error) && !error) return std::string{};
  std::ifstream in{file, std::ios::binary};
  std::ostringstream text;
  if (!in || (in.peek() != std::ifstream::traits_type::eof() && !(text << in.rdbuf()))) {
    return failure(ErrorCode::io_failed, fmt::format("cannot read '{}'", file.string()));
  }
  return text.str();
}

}  // namespace

ModelStore::ModelStore(const fs::path& site_file, std::string site_id)
    : folder_(versions_folder(site_file)), site_id_(std::move(site_id)) {}

fs::path ModelStore::file_of(std::string_view version) const {
  return folder_ / (std::string{version} + ".json");
}

/// Full names of the versions that have a file, sorted.
Result<std::vector<std::string>> ModelStore::names() const {
  std::vector<std::string> names;
  std::error_code error;
  if (!fs::exists(folder_, error) && !error) return names;
  for (fs::directory_iterator entry{folder_, error}, end; !error && entry != end;
       entry.increment(error)) {
    const fs::path& file = entry->path();
    if (file.extension() == ".json" && is_version_name(file.stem().string())) {
      names.push_back(file.stem().string());
    }
  }
  if (error) {
    return failure(ErrorCode::io_failed,
                   fmt::format("cannot read folder '{}': {}", folder_.string(), error.message()));
  }
  std::ranges::sort(names);
  return names;
}

Result<std::string> ModelStore::full_name(std::string_view version) const {
  if (version == kBaseVersion) return std::string{version};
  const auto known = TRY(names());
  std::vector<std::string> fitting;
  std::string all{kBaseVersion};
  for (const std::string& name : known) {
    if (version.size() >= kLeastDigits && name.starts_with(version)) fitting.push_back(name);
    all += ", " + short_version(name);
  }
  if (fitting.size() == 1) return fitting.front();
  if (fitting.empty()) {
    return failure(ErrorCode::not_found,
                   fmt::format("the model of site '{}' has no version '{}'; it has {}", site_id_,
                               version, all));
  }
  return failure(ErrorCode::invalid_value,
                 fmt::format("'{}' begins {} versions: {}; give more digits", version,
                             fitting.size(), fmt::join(fitting, ", ")));
}

Result<std::string> ModelStore::active_name() const {
  auto text = text_of(folder_ / "active");
  if (!text) return text;
  while (!text->empty() && text->back() == '\n') text->pop_back();
  if (text->empty()) return std::string{kBaseVersion};
  if (*text == kBaseVersion || is_version_name(*text)) return text;
  return failure(ErrorCode::malformed,
                 fmt::format("'{}' is damaged: it names no version; `recald model revert` with a "
                             "version writes it anew",
                             (folder_ / "active").string()));
}

Result<VersionList> ModelStore::list() const {
  const auto known = TRY(names());
  auto in_force = TRY(active_name());
  VersionList list{{diagnosis::base_version(site_id_)}, std::move(in_force), {}};
  for (const std::string& name : known) {
    auto version = read_version_file(file_of(name));
    if (version) {
      list.versions.push_back(std::move(*version));
    } else {
      list.damaged.push_back(version.error().message);
    }
  }
  std::ranges::stable_sort(list.versions.begin() + 1, list.versions.end(), {},
                           &ModelVersion::created_at);
  return list;
}

Result<ModelVersion> ModelStore::load(std::string_view version) const {
  const auto name = TRY(full_name(version));
  if (name == kBaseVersion) return diagnosis::base_version(site_id_);
  return read_version_file(file_of(name));
}

Result<ModelVersion> ModelStore::active() const {
  const auto name = TRY(active_name());
  return load(name);
}

Result<ModelVersion> ModelStore::save(ModelVersion version) const {
  version.parent = TRY(full_name(version.parent));
  auto named = named_by_content(std::move(version));
  if (!named) return named;
  const fs::path file = file_of(named->version);
  std::error_code ignored;
  if (fs::exists(file, ignored)) return read_version_file(file);
  TRY(system::make_folder(folder_));
  TRY(system::write_file(file, version_json(*named)));
  return named;
}

/// Only the status of a version ever changes; the drawings have no file to store it in.
Result<void> ModelStore::mark(ModelVersion version, VersionStatus status) const {
  if (version.version == kBaseVersion || version.status == status) return {};
  version.status = status;
  return system::write_file(file_of(version.version), version_json(version));
}

/// Marks a version and its ancestors, up to the first one that `until` shares. A damaged parent has
/// no status to mark and ends the walk; it must not prevent leaving the version.
Result<void> ModelStore::mark_reverted(ModelVersion version, const ModelVersion& until) const {
  std::vector<std::string> kept{std::string{kBaseVersion}};
  for (Result<ModelVersion> kin = until; kin && kin->version != kBaseVersion;) {
    kept.push_back(kin->version);
    kin = load(std::string{kin->parent});
  }
  while (std::ranges::find(kept, version.version) == kept.end()) {
    if (auto marked = mark(version, VersionStatus::reverted); !marked) return marked;
    auto parent = load(version.parent);
    if (!parent) return {};
    version = std::move(*parent);
  }
  return {};
}

Result<ModelVersion> ModelStore::put_in_force(ModelVersion next, std::string_view action,
                                              const std::string& from,
                                              const std::string& at) const {
  TRY(mark(next, VersionStatus::accepted));
  TRY(system::make_folder(folder_));
  const fs::path history = folder_ / "history.jsonl";
  auto text = TRY(text_of(history));
  const nlohmann::ordered_json line = {
      {"at", at}, {"action", action}, {"from", from}, {"to", next.version}};
  TRY(system::write_file(history, text + line.dump() + "\n"));
  TRY(system::write_file(folder_ / "active", next.version + "\n"));
  next.status = VersionStatus::accepted;
  return next;
}

Result<ModelVersion> ModelStore::activate(std::string_view version, const std::string& at) const {
  auto next = load(version);
  if (!next) return next;
  const auto from = TRY(active_name());
  if (next->version == from) return tl::unexpected(in_force_already(from));
  return put_in_force(std::move(*next), "activate", from, at);
}

Result<ModelVersion> ModelStore::revert(std::string_view target, const std::string& at) const {
  // With a target, a damaged version in force is no obstacle: this is the way out of it.
  const auto from = active();
  if (!from && target.empty()) return from;
  const std::string from_name = active_name().value_or("unknown");
  if (from_name == kBaseVersion && (target.empty() || target == kBaseVersion)) {
    return failure(ErrorCode::invalid_value,
                   "the model is as the drawings have it already; there is nothing to revert");
  }
  auto next = load(target.empty() ? std::string_view{from->parent} : target);
  if (!next) return next;
  TRY(check_revert(*next, from_name));
  if (from) {
    TRY(mark_reverted(*from, *next));
  }
  return put_in_force(std::move(*next), "revert", from_name, at);
}

}  // namespace recald::models
