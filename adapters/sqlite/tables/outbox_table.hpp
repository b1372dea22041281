/// What is still to be told outside, in the store's `outbox` table: numbers of intervals and months
/// that somebody has not had yet. A destination's position is in `cursor`, as "outbox NAME".
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "adapters/ports/store.hpp"
#include "adapters/sqlite/tables/database.hpp"

namespace recald::sqlite {

/// The text that inserts an entry where there is any destination; without one it inserts nothing.
/// Parameters: meter, start of the interval or null, month or null, revision.
[[nodiscard]] std::string insert_outbox_entry();

/// As the members of Store with these names.
[[nodiscard]] Result<void> keep_outbox_for(Database& database,
                                           const std::vector<std::string>& destinations);
[[nodiscard]] Result<std::vector<OutboxEntry>> outbox_after(Database& database, std::int64_t number,
                                                            int limit);
[[nodiscard]] Result<OutboxPosition> outbox_position(Database& database,
                                                     const std::string& destination);
[[nodiscard]] Result<void> put_outbox_position(Database& database, const std::string& destination,
                                               std::int64_t number);

/// Numbers are given again from here on (adapters/ports/destination_cursors.hpp).
[[nodiscard]] Result<void> forget_identities(Database& database);

}  // namespace recald::sqlite
