/// The libraries that recald stands on, for reports of bugs.
#pragma once

#include <string>
#include <vector>

namespace recald {

struct LibraryVersion {
  std::string name;
  std::string version;  ///< Of what is loaded; of a library of headers alone, what was compiled.
};

[[nodiscard]] std::vector<LibraryVersion> library_versions();

}  // namespace recald
