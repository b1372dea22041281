#include "daemon/commands/commit.hpp"

#include "daemon/commands/commit_text.hpp"  // made anew with each commit: nothing else includes it

namespace recald::daemon {

std::string_view built_commit() { return kCommitText; }

}  // namespace recald::daemon
