#include "tests/support/power_cut.hpp"

#include <algorithm>

#include "tests/support/temporary_folder.hpp"

namespace recald::testing {
namespace {

constexpr std::size_t kSector = 512;

std::string contents(const std::string& path) {
  std::error_code error;
  return !path.empty() && std::filesystem::is_regular_file(path, error) ? read_text(path) : "";
}

/// Of the sectors that differ each as it was or as it is, whatever the order of writing.
std::string torn(const std::string& before, const std::string& after, Rng& rng) {
  std::string left = rng.below(2) == 0 ? before : after;
  const std::string& other = left == before ? after : before;
  for (std::size_t at = 0; at < std::min(left.size(), other.size()); at += kSector) {
    const std::size_t size = std::min({kSector, left.size() - at, other.size() - at});
    if (rng.below(2) == 0) left.replace(at, size, other, at, size);
  }
  return left;
}

std::string parent(const std::string& path) {
  return std::filesystem::path{path}.parent_path().string();
}

}  // namespace

PowerCut::PowerCut(std::filesystem::path folder) : folder_(std::move(folder)) {
  for (const auto& entry : std::filesystem::recursive_directory_iterator{folder_}) {
    if (!entry.is_regular_file()) continue;
    const std::string path = entry.path().string();
    now_[path] = std::make_shared<File>(File{contents(path), path});
  }
  durable_ = now_;
}

void PowerCut::watch(const FileChange& change) {
  if (!change.path.starts_with(folder_.string())) return;
  if (change.call == "fsync" || change.call == "fdatasync") {
    sync(change.path);
  } else if (change.call == "rename") {
    change_name(change.path, change.to);
  } else if (change.call.starts_with("unlink") || change.call == "remove") {
    if (now_.contains(change.path)) change_name(change.path, "");
  } else if (change.call.starts_with("open") && !now_.contains(change.path)) {
    change_name("", change.path);
  }
}

void PowerCut::write_image(Rng& rng, const std::filesystem::path& to) const {
  std::filesystem::remove_all(to);
  std::filesystem::create_directories(to);
  Names names = durable_;
  const std::size_t kept = rng.below(pending_.size() + 1);
  for (std::size_t i = 0; i < kept; ++i) apply(pending_[i], names);
  for (const auto& [path, file] : names) {
    if (path.ends_with("-shm")) continue;  // memory, not disk
    const std::filesystem::path image = to / std::filesystem::relative(path, folder_);
    std::filesystem::create_directories(image.parent_path());
    const std::string after = file->path.empty() ? file->durable : contents(file->path);
    const auto kind = rng.below(3);
    write_text(image, kind == 0   ? file->durable
                      : kind == 1 ? after
                                  : torn(file->durable, after, rng));
  }
}

void PowerCut::change_name(const std::string& from, const std::string& to) {
  NameChange change{from, to, {}};
  const auto known = now_.find(from);
  change.file = known != now_.end() ? known->second : std::make_shared<File>();
  if (const auto replaced = now_.find(to); replaced != now_.end()) replaced->second->path.clear();
  change.file->path = to;
  apply(change, now_);
  pending_.push_back(std::move(change));
}

void PowerCut::sync(const std::string& path) {
  if (const auto file = now_.find(path); file != now_.end()) {
    file->second->durable = contents(path);
    return;
  }
  const auto concerns = [&](const NameChange& change) {
    return parent(change.from) == path || parent(change.to) == path;
  };
  const auto last = std::find_if(pending_.rbegin(), pending_.rend(), concerns).base();
  std::for_each(pending_.begin(), last, [&](const NameChange& one) { apply(one, durable_); });
  pending_.erase(pending_.begin(), last);
}

void PowerCut::apply(const NameChange& change, Names& names) {
  if (!change.from.empty()) names.erase(change.from);
  if (!change.to.empty()) names[change.to] = change.file;
}

}  // namespace recald::testing
