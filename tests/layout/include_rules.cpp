#include "tests/layout/include_rules.hpp"

#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>
#include <functional>
#include <string_view>

namespace recald::layout {
namespace {

/// From the bottom to the top: a room may include itself and those before it.
constexpr auto kOrder = std::to_array<std::string_view>({
    "core",
    "adapters",
    "daemon/version",
    "daemon/site/config",
    "daemon/site/replay",
    "daemon/site/setup",
    "daemon/site/model",
    "daemon/site/calibrate",
    "daemon/site/diagnose",
    "daemon/site/drift",
    "daemon/site/results",
    "daemon/site/savings",
    "daemon/gateway/poll",
    "daemon/gateway/ingest",
    "daemon/gateway/feed",
    "daemon/gateway/upkeep",
    "daemon/gateway/serve",
    "daemon/gateway/registers",
    "daemon/gateway/forward",
    "daemon/gateway/alert",
    "daemon/gateway/recording",
    "daemon/gateway/run",
    "daemon/gateway/replay",
    "daemon/fleet/config",
    "daemon/fleet/ingest",
    "daemon/fleet/work",
    "daemon/fleet/serve",
    "daemon/commands",
    "daemon/main",
});

/// A building that shares the equations of the model it is held against proves nothing: values and
/// file formats are all that simulators have of core, and the reader of TOML of adapters.
constexpr auto kForSimulators = std::to_array<std::string_view>(
    {"core/absent", "core/metering", "core/random", "core/result", "core/text", "adapters/toml"});

bool is_below(std::string_view path, std::string_view room) {
  return path.starts_with(room) && path.size() > room.size() &&
         (path[room.size()] == '/' || path[room.size()] == '.');
}

/// Place in the order; its size for what has none.
std::size_t rank(std::string_view path) {
  const auto room =
      std::ranges::find_if(kOrder, [&](std::string_view one) { return is_below(path, one); });
  return static_cast<std::size_t>(room - kOrder.begin());
}

bool is_allowed(std::string_view from, std::string_view to) {
  // What keeps a store is chosen in one room.
  if (is_below(to, "adapters/sqlite")) {
    // EnergyPlus writes its results in one such file.
    const bool reads_results =
        is_below(from, "adapters/energyplus") && to == "adapters/sqlite/tables/database.hpp";
    return is_below(from, "adapters/sqlite") || is_below(from, "adapters/stores") || reads_results;
  }
  if (is_below(from, "simulators")) {
    return is_below(to, "simulators") ||
           std::ranges::any_of(kForSimulators,
                               [&](std::string_view room) { return is_below(to, room); });
  }
  return rank(from) < kOrder.size() && rank(to) <= rank(from);
}

/// Files that lie beside a wing's folders, `daemon/main.cpp`, are rooms of their own.
std::string folder_of(const std::string& file) {
  const std::size_t last = file.rfind('/');
  return file.find('/') == last ? file.substr(0, file.rfind('.')) : file.substr(0, last);
}

/// A folder of core, adapters or simulators with all folders in it. The daemon's are ranked by
/// kOrder.
std::string room_of(const std::string& file) {
  const std::string folder = folder_of(file);
  if (folder.starts_with("daemon")) return folder;
  return folder.substr(0, folder.find('/', folder.find('/') + 1));
}

/// @param place_of  What a file is taken for: its folder, or its room.
void find_circles(const Includes& includes,
                  const std::function<std::string(const std::string&)>& place_of,
                  std::set<std::string>& found) {
  std::map<std::string, std::set<std::string>> reached;
  for (const auto& [file, included] : includes) {
    std::set<std::string>& next = reached[place_of(file)];
    for (const std::string& other : included) {
      if (place_of(other) != place_of(file)) next.insert(place_of(other));
    }
  }
  for (bool grows = true; grows;) {
    grows = false;
    for (auto& [folder, next] : reached) {
      std::set<std::string> further;
      for (const std::string& one : next) {
        if (const auto known = reached.find(one); known != reached.end()) {
          further.insert(known->second.begin(), known->second.end());
        }
      }
      const std::size_t before = next.size();
      next.merge(further);
      grows = grows || next.size() > before;
    }
  }
  for (const auto& [folder, next] : reached) {
    if (!next.contains(folder)) continue;
    std::string circle;
    for (const std::string& other : next) {
      const auto back = reached.find(other);
      const bool is_part = back != reached.end() && back->second.contains(folder);
      if (is_part) circle += (circle.empty() ? "" : " ") + other;
    }
    found.insert(circle);
  }
}

}  // namespace

Includes read_includes(const std::string& root) {
  constexpr std::string_view begin = "#include \"";
  Includes includes;
  for (const char* top : {"core", "adapters", "daemon", "simulators"}) {
    for (const auto& entry :
         std::filesystem::recursive_directory_iterator(std::filesystem::path{root} / top)) {
      if (entry.path().extension() != ".hpp" && entry.path().extension() != ".cpp") continue;
      const std::string file = entry.path().lexically_relative(root).generic_string();
      std::set<std::string>& included = includes[file];
      std::ifstream in(entry.path());
      for (std::string line; std::getline(in, line);) {
        if (!line.starts_with(begin)) continue;
        included.insert(line.substr(begin.size(), line.rfind('"') - begin.size()));
      }
    }
  }
  return includes;
}

std::vector<std::string> forbidden_arrows(const Includes& includes) {
  std::vector<std::string> found;
  for (const auto& [file, included] : includes) {
    for (const std::string& other : included) {
      if (!is_allowed(file, other)) found.push_back(file + " must not include " + other);
    }
  }
  return found;
}

std::vector<std::string> circles(const Includes& includes) {
  std::set<std::string> found;
  find_circles(includes, folder_of, found);
  find_circles(includes, room_of, found);
  return {found.begin(), found.end()};
}

std::vector<std::string> crowded(const Includes& includes) {
  constexpr int kFiles_max = 30;
  std::map<std::string, int> files;
  for (const auto& [file, included] : includes) ++files[folder_of(file)];
  std::vector<std::string> found;
  for (const auto& [folder, count] : files) {
    if (count > kFiles_max && !folder.ends_with("/effects")) found.push_back(folder);
  }
  return found;
}

}  // namespace recald::layout
