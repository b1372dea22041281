#include "adapters/stores/register_text.hpp"

#include "adapters/sqlite/tables/register_json.hpp"

namespace recald::stores {

std::string register_text(const RegisterState& state) { return sqlite::to_json(state); }

Result<RegisterState> read_register_text(std::string_view text) {
  return sqlite::register_from_json(text);
}

}  // namespace recald::stores
