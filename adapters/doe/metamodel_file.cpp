#include "adapters/doe/metamodel_file.hpp"

#include <fmt/format.h>

#include <set>
#include <string>

#include "adapters/doe/table_reader.hpp"

namespace recald::doe {

using model::metamodel::NamedCoefficient;

Result<std::vector<NamedCoefficient>> read_metamodel(const std::filesystem::path& file) {
  auto table = TRY(TableReader::open(file));
  const auto term_column = TRY(table.require("term"));
  const auto coefficient_column = TRY(table.require("coef"));
  std::vector<NamedCoefficient> terms;
  std::set<std::string> seen;
  for (;;) {
    const auto more = TRY(table.next());
    if (!more) break;
    std::string term{table.text(term_column)};
    if (term.empty()) return table.wrong("column 'term' is blank");
    if (!seen.insert(term).second) return table.wrong(fmt::format("term '{}' comes twice", term));
    const auto coefficient = TRY(table.number(coefficient_column));
    terms.push_back({std::move(term), coefficient});
  }
  if (!terms.empty()) return terms;
  return failure(ErrorCode::not_enough_data,
                 fmt::format("'{}' has no term; it needs a row for each", file.string()));
}

}  // namespace recald::doe
