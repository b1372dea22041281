#include "daemon/gateway/forward/outbox_identity.hpp"

#include <limits>
#include <random>

#include "adapters/ports/destination_cursors.hpp"

namespace recald::daemon {
namespace {

Result<std::int64_t> put_new_identity(Store& store, const std::string& destination) {
  std::random_device random;
  std::uniform_int_distribution<std::int64_t> any{1, std::numeric_limits<std::int64_t>::max()};
  const std::int64_t identity = any(random);
  if (auto put = store.put_cursor(identity_cursor(destination), identity); !put) {
    return tl::unexpected(put.error());
  }
  return identity;
}

}  // namespace

Result<std::int64_t> outbox_identity(Store& store, const std::string& destination) {
  const auto known = store.cursor(identity_cursor(destination));
  if (!known) return tl::unexpected(known.error());
  return *known ? **known : put_new_identity(store, destination);
}

Result<void> begin_anew(Store& store, const std::string& destination) {
  return store.as_one([&]() -> Result<void> {
    if (auto put = put_new_identity(store, destination); !put) return tl::unexpected(put.error());
    return store.put_cursor(history_cursor(destination), 0);
  });
}

Result<bool> has_taken(Store& store, const std::string& destination, std::int64_t identity) {
  const auto taken = store.cursor(taken_cursor(destination));
  if (!taken) return tl::unexpected(taken.error());
  return *taken == identity;
}

Result<void> put_taken(Store& store, const std::string& destination, std::int64_t identity) {
  return store.put_cursor(taken_cursor(destination), identity);
}

}  // namespace recald::daemon
