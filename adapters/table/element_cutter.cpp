#include "adapters/table/element_cutter.hpp"

#include <algorithm>

namespace recald::table {
namespace {

constexpr std::size_t kPiece = 64 * 1024;

bool ends_name(char c) {
  return c == '>' || c == '/' || c == ' ' || c == '\t' || c == '\r' || c == '\n';
}

}  // namespace

std::string_view local_name(std::string_view name) {
  const std::size_t colon = name.find(':');
  return colon == std::string_view::npos ? name : name.substr(colon + 1);
}

ElementCutter::ElementCutter(csv::ByteSource source, std::vector<std::string> names,
                             std::size_t bytes_max)
    : source_{std::move(source)}, names_{std::move(names)}, bytes_max_{bytes_max} {}

bool ElementCutter::fail(std::string_view reason) {
  error_ = Error{ErrorCode::malformed, std::string{reason}};
  return false;
}

bool ElementCutter::refill() {
  if (error_) return false;
  if (at_ > 0) {
    buffer_.erase(0, at_);
    at_ = 0;
  }
  if (buffer_.size() > bytes_max_) return fail("one element is larger than can be read");
  const std::size_t had = buffer_.size();
  buffer_.resize(had + kPiece);
  const auto got = source_(buffer_.data() + had, kPiece);
  buffer_.resize(had + (got ? *got : 0));
  if (!got) error_ = got.error();
  return got && *got > 0;
}

/// @param from, at  After `at_`, which may move to the front meanwhile.
bool ElementCutter::find(std::string_view text, std::size_t from, std::size_t& at) {
  for (;;) {
    const std::size_t found = buffer_.find(text, at_ + from);
    if (found != std::string::npos) {
      at = found - at_;
      return true;
    }
    // The text may straddle the end of the buffer.
    const std::size_t left = buffer_.size() - at_;
    from = std::max(from, left >= text.size() ? left - text.size() + 1 : 0);
    if (!refill()) return false;
  }
}

/// Finds the '>' that ends a tag; quotes in the tag may contain others.
bool ElementCutter::find_tag_end(std::size_t from, std::size_t& at) {
  char quote = '\0';
  for (std::size_t i = from;; ++i) {
    while (at_ + i >= buffer_.size()) {
      if (!refill()) return false;
    }
    const char c = buffer_[at_ + i];
    if (quote != '\0') {
      if (c == quote) quote = '\0';
    } else if (c == '"' || c == '\'') {
      quote = c;
    } else if (c == '>') {
      at = i;
      return true;
    }
  }
}

bool ElementCutter::skip_past(std::string_view mark) {
  std::size_t at = 0;
  if (!find(mark, 0, at)) return error_ ? false : fail("it ends within a comment");
  at_ += at + mark.size();
  return true;
}

bool ElementCutter::cut_from(std::string_view name, std::size_t tag_end,
                             std::string_view& element) {
  if (buffer_[at_ + tag_end - 1] == '/') {
    element = std::string_view{buffer_}.substr(at_, tag_end + 1);
    at_ += tag_end + 1;
    return true;
  }
  const std::string closing = "</" + std::string{name};
  std::size_t from = tag_end + 1;
  std::size_t at = 0;
  for (;;) {
    std::size_t end = 0;
    if (!find(closing, from, at) || !find_tag_end(at, end)) {
      return error_ ? false : fail("it ends within <" + std::string{name} + ">");
    }
    if (ends_name(buffer_[at_ + at + closing.size()])) {
      element = std::string_view{buffer_}.substr(at_, end + 1);
      at_ += end + 1;
      return true;
    }
    from = at + closing.size();
  }
}

bool ElementCutter::next(std::string_view& element) {
  std::size_t at = 0;
  while (!error_) {
    if (!find("<", 0, at)) return false;
    at_ += at;
    while (buffer_.size() - at_ < 9 && refill()) {
    }
    const std::string_view head = std::string_view{buffer_}.substr(at_, 9);
    if (head.substr(0, 4) == "<!--") {
      if (!skip_past("-->")) return false;
      continue;
    }
    if (head == "<![CDATA[") {
      if (!skip_past("]]>")) return false;
      continue;
    }
    std::size_t end = 0;
    if (!find_tag_end(1, end)) return error_ ? false : fail("it ends within a tag");
    ++tags_;
    std::size_t length = 1;
    while (!ends_name(buffer_[at_ + length])) ++length;
    const std::string name = buffer_.substr(at_ + 1, length - 1);
    if (std::find(names_.begin(), names_.end(), local_name(name)) != names_.end()) {
      return cut_from(name, end, element);
    }
    at_ += end + 1;
  }
  return false;
}

}  // namespace recald::table
