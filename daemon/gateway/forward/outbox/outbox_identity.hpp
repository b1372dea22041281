/// Which numbering the positions of a destination are of, for one that remembers them: a random
/// number. Where numbers may be given again, or the destination has lost what it had, it is told
/// everything under another.
#pragma once

#include <cstdint>
#include <string>

#include "adapters/ports/store.hpp"
#include "core/result.hpp"

namespace recald::daemon {

/// Made when there is none. @return 1 … 2^63 - 1
[[nodiscard]] Result<std::int64_t> outbox_identity(Store& store, const std::string& destination);

/// Another identity, with all of the store's past before it.
[[nodiscard]] Result<void> begin_anew(Store& store, const std::string& destination);

/// Whether the destination has taken anything of the outbox under its present identity.
[[nodiscard]] Result<bool> has_taken(Store& store, const std::string& destination,
                                     std::int64_t identity);
[[nodiscard]] Result<void> put_taken(Store& store, const std::string& destination,
                                     std::int64_t identity);

}  // namespace recald::daemon
