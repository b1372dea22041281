#include "adapters/system/time_zone_release.hpp"

#include <fstream>

namespace recald::system {

std::string time_zone_release() {
  std::ifstream in{"/usr/share/zoneinfo/tzdata.zi"};
  std::string hash;
  std::string word;
  std::string release;
  if (in >> hash >> word >> release && hash == "#" && word == "version") return release;
  return "unknown";
}

}  // namespace recald::system
