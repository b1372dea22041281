#include "daemon/gateway/forward/outbox/outbox_identity.hpp"

#include <limits>
#include <random>

#include "adapters/ports/destination_cursors.hpp"

namespace recald::daemon {
namespace {

Result<std::int64_t> put_new_identity(Store& store, const std::string& destination) {
  std::random_device random;
  std::uniform_int_distribution<std::int64_t> any{1, std::numeric_limits<std::int64_t>::max()};
  const std::int64_t identity = any(random);
  TRY(store.put_cursor(identity_cursor(destination), identity));
  return identity;
}

}  // namespace

Result<std::int64_t> outbox_identity(Store& store, const std::string& destination) {
  const auto known = TRY(store.cursor(identity_cursor(destination)));
  return known ? *known : put_new_identity(store, destination);
}

Result<void> begin_anew(Store& store, const std::string& destination) {
  return store.as_one([&]() -> Result<void> {
    TRY(put_new_identity(store, destination));
    return store.put_cursor(history_cursor(destination), 0);
  });
}

Result<bool> has_taken(Store& store, const std::string& destination, std::int64_t identity) {
  const auto taken = TRY(store.cursor(taken_cursor(destination)));
  return taken == identity;
}

Result<void> put_taken(Store& store, const std::string& destination, std::int64_t identity) {
  return store.put_cursor(taken_cursor(destination), identity);
}

}  // namespace recald::daemon
