/// Readings that somebody puts in the place of stored ones.
#pragma once

#include <string>

namespace recald::daemon {

/// Who puts readings right, and why; kept with them as an edit.
struct Correction {
  std::string author;
  std::string reason;  ///< Not empty.
  std::string sha256;  ///< Of what was sent.
};

}  // namespace recald::daemon
