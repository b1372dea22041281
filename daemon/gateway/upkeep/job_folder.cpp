#include "daemon/gateway/upkeep/job_folder.hpp"

#include <fmt/format.h>

namespace recald::daemon {

std::filesystem::path job_folder(const StoreConfig& store, JobKind kind, std::int64_t number) {
  return store.file.parent_path() / (store.file.stem().string() + "-results") /
         fmt::format("{}-{}", name_of(kind), number);
}

}  // namespace recald::daemon
