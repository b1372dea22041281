/// Readings that replace stored ones on a person's request.
#pragma once

#include <string>

namespace recald::daemon {

/// Who corrects readings, and why; stored with them as an edit.
struct Correction {
  std::string author;
  std::string reason;  ///< Not empty.
  std::string sha256;  ///< Of the request's content.
};

}  // namespace recald::daemon
