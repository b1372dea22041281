#include "adapters/csv/other_meters.hpp"

#include <algorithm>

#include "core/text/printable.hpp"

namespace recald::csv {
namespace {

constexpr std::size_t kNamedMax = 20;  // a column of numbers must not fill the memory

}  // namespace

void OtherMeters::add(std::string_view name) {
  ++lines_;
  const auto known = std::find_if(named_.begin(), named_.end(),
                                  [&](const Other& other) { return other.name == name; });
  if (known != named_.end()) {
    ++known->lines;
  } else if (named_.size() < kNamedMax) {
    named_.push_back({std::string{name}, 1});
  } else {
    ++more_lines_;
  }
}

std::string OtherMeters::words() const {
  if (empty()) return {};
  const bool is_one = named_.size() == 1;
  std::string words = is_one
                          ? "1 meter is not configured, and its lines were left out: "
                          : (more_lines_ > 0 ? "more than " : "") + std::to_string(named_.size()) +
                                " meters are not configured, and their lines were left out: ";
  for (std::size_t i = 0; i < named_.size(); ++i) {
    if (i > 0) words += ", ";
    words += printable(named_[i].name) + " (" + std::to_string(named_[i].lines) + ")";
  }
  if (more_lines_ > 0) words += " and others (" + std::to_string(more_lines_) + ")";
  return words;
}

}  // namespace recald::csv
