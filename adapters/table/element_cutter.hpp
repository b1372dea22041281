/// Cuts elements out of an XML text of any length, one after the other.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "adapters/csv/line_reader.hpp"

namespace recald::table {

/// The name without its namespace prefix: "row" of "x:row".
[[nodiscard]] std::string_view local_name(std::string_view name);

/// Finds the elements with given names anywhere in a document, so that a long document is read
/// piece by piece. Elements of one name must not contain each other. Returns only complete
/// elements, each to be parsed on its own.
class ElementCutter {
 public:
  /// @param names      Local names.
  /// @param bytes_max  Of one element; a larger one is an error.
  ElementCutter(csv::ByteSource source, std::vector<std::string> names, std::size_t bytes_max);

  /// The next element, from its '<' to its last '>'; valid until the next call.
  /// @return false at the end, and when the source fails or an element is cut off;
  ///         then see `error`.
  bool next(std::string_view& element);
  [[nodiscard]] const std::optional<Error>& error() const { return error_; }
  [[nodiscard]] std::uint64_t tags() const { return tags_; }  ///< Seen so far.

 private:
  bool refill();
  bool find(std::string_view text, std::size_t from, std::size_t& at);
  bool find_tag_end(std::size_t from, std::size_t& at);
  bool skip_past(std::string_view mark);
  bool cut_from(std::string_view name, std::size_t tag_end, std::string_view& element);
  bool fail(std::string_view reason);

  csv::ByteSource source_;
  std::vector<std::string> names_;
  std::size_t bytes_max_;
  std::string buffer_;
  std::size_t at_ = 0;  ///< Where to look next.
  std::uint64_t tags_ = 0;
  std::optional<Error> error_;
};

}  // namespace recald::table
