/// What `recald doctor` finds out. No fact has the content of a secret, nor an address that may be
/// one, and nothing is written to find it out.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "daemon/site/config/site_config.hpp"

namespace recald::daemon {

struct Fact {
  std::string name;
  std::string value;
  std::string problem = {};  ///< What is wrong and what to do, in a sentence; empty: nothing.
  bool stops_work = false;   ///< Until it is mended, something that was asked for is not done.
};

/// Of the program and the machine.
[[nodiscard]] std::vector<Fact> machine_facts();

/// Of a site file; and of its store, its daemon and its secrets if the file can be read.
[[nodiscard]] std::vector<Fact> site_facts(const std::filesystem::path& file);

/// Each file that the site file names, opened; each folder that is written to. Secrets are apart.
[[nodiscard]] std::vector<Fact> named_files(const SiteConfig& site);

/// "3.1 MiB", "12.0 GiB"
[[nodiscard]] std::string size_words(double bytes);

}  // namespace recald::daemon
