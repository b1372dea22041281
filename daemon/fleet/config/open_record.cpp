#include "daemon/fleet/config/open_record.hpp"

#include "adapters/http/credentials.hpp"

namespace recald::daemon {

Result<std::unique_ptr<postgres::Connection>> open_record(const RecordConfig& config,
                                                          const postgres::Patience& patience) {
  std::string password;
  if (!config.password_file.empty()) {
    password = TRY(http::read_password_file(config.password_file));
  }
  return postgres::Connection::open(config.url, password, patience);
}

}  // namespace recald::daemon
