#include "adapters/sqlite/recovery/page_rows.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <fstream>
#include <set>
#include <system_error>
#include <utility>

namespace recald::sqlite {
namespace {

/// The page size of every file that recald has created.
constexpr std::size_t kPage = 4096;
constexpr std::size_t kLogHeader = 32;
constexpr std::size_t kFrameHeader = 24;
/// The longest stored text is a job's result.
constexpr std::size_t kPayloadMax = 64 * 1024 * 1024;
constexpr std::size_t kColumnsMax = 64;

std::uint32_t big_endian(Bytes bytes, std::size_t at, std::size_t size) {
  std::uint32_t value = 0;
  for (std::size_t i = 0; i < size; ++i) value = value << 8 | bytes[at + i];
  return value;
}

/// Reads bytes in sequence; after an attempt to read past the end, it fails for good.
class Reader {
 public:
  explicit Reader(Bytes bytes) : rest_(bytes) {}

  std::uint64_t varint() {
    std::uint64_t value = 0;
    for (int i = 0; i < 9; ++i) {
      const Bytes one = take(1);
      if (one.empty()) return 0;
      if (i == 8) return value << 8 | one[0];
      value = value << 7 | (one[0] & 0x7Fu);
      if ((one[0] & 0x80u) == 0) return value;
    }
    return value;
  }

  /// Empty if too few bytes are left, or if none are requested.
  Bytes take(std::size_t size) {
    if (size > rest_.size()) {
      has_failed_ = true;
      rest_ = {};
      return {};
    }
    const Bytes taken = rest_.first(size);
    rest_ = rest_.subspan(size);
    return taken;
  }

  [[nodiscard]] bool has_failed() const { return has_failed_; }
  [[nodiscard]] bool is_at_end() const { return rest_.empty(); }

 private:
  Bytes rest_;
  bool has_failed_ = false;
};

std::int64_t signed_integer(Bytes bytes) {
  std::uint64_t value = (bytes[0] & 0x80u) != 0 ? ~std::uint64_t{0} : 0;
  for (const std::uint8_t byte : bytes) value = value << 8 | byte;
  return static_cast<std::int64_t>(value);
}

std::optional<Value> integer_of(std::int64_t value) {
  return Value{.kind = Value::Kind::integer, .integer = value};
}

/// One value of a serial type, from a record's body. Nothing for a blob, since we store none.
std::optional<Value> value_of(std::uint64_t type, Reader& body) {
  constexpr std::array<std::size_t, 7> kIntegerSizes{0, 1, 2, 3, 4, 6, 8};
  if (type == 0) return Value{};
  if (type == 8) return integer_of(0);
  if (type == 9) return integer_of(1);
  if (type == 7) {
    const Bytes bytes = body.take(8);
    if (bytes.empty()) return {};
    return Value{.kind = Value::Kind::real, .real = std::bit_cast<double>(signed_integer(bytes))};
  }
  if (type < kIntegerSizes.size()) {
    const Bytes bytes = body.take(kIntegerSizes[type]);
    if (bytes.empty()) return {};
    return integer_of(signed_integer(bytes));
  }
  if (type < 12 || type % 2 == 0 || type > 2 * kPayloadMax) return {};
  const Bytes bytes = body.take((type - 13) / 2);
  if (body.has_failed()) return {};
  return Value{.kind = Value::Kind::text,
               .text = {reinterpret_cast<const char*>(bytes.data()), bytes.size()}};
}

/// Nothing if the bytes are not exactly one record.
std::optional<std::vector<Value>> values_of(Bytes record) {
  Reader start{record};
  const std::uint64_t header_size = start.varint();
  if (start.has_failed() || header_size > record.size()) return {};
  Reader header{record.first(header_size)};
  Reader body{record.subspan(header_size)};
  (void)header.varint();
  std::vector<Value> values;
  while (!header.is_at_end()) {
    const std::uint64_t type = header.varint();
    if (header.has_failed() || values.size() == kColumnsMax) return {};
    auto value = value_of(type, body);
    if (!value) return {};
    values.push_back(std::move(*value));
  }
  if (!body.is_at_end()) return {};
  return values;
}

/// Appends the part of a record that did not fit on its page. A chain with a loop is damage.
bool append_overflow(std::vector<std::uint8_t>& record, std::size_t size, std::uint32_t next,
                     const PageOf& page_of) {
  std::set<std::uint32_t> seen;
  while (record.size() < size) {
    if (!seen.insert(next).second) return false;
    const std::vector<std::uint8_t> page = page_of(next);
    if (page.size() < 4) return false;
    const std::size_t more = std::min(size - record.size(), page.size() - 4);
    record.insert(record.end(), page.begin() + 4, page.begin() + 4 + static_cast<long>(more));
    next = big_endian(page, 0, 4);
  }
  return true;
}

/// How a kind of page stores rows.
struct PageKind {
  bool has_rowid;
  bool is_leaf;
};

std::optional<PageKind> kind_of(std::uint8_t type) {
  if (type == 13) return PageKind{true, true};
  if (type == 10) return PageKind{false, true};
  if (type == 2) return PageKind{false, false};  // its rows lie between those of its children
  return {};
}

/// The part of a record of this size that stays on the page.
std::size_t size_on_page(std::size_t size, bool has_rowid) {
  constexpr std::size_t kFits = (kPage - 12) * 64 / 255 - 23;
  constexpr std::size_t kLeast = (kPage - 12) * 32 / 255 - 23;
  const std::size_t fits = has_rowid ? kPage - 35 : kFits;
  if (size <= fits) return size;
  const std::size_t kept = kLeast + (size - kLeast) % (kPage - 4);
  return kept <= fits ? kept : kLeast;
}

std::optional<PageRow> row_of(Bytes cell, const PageKind& kind, const PageOf& page_of) {
  Reader reader{cell};
  if (!kind.is_leaf) (void)reader.take(4);  // the child's page number
  const std::uint64_t size = reader.varint();
  PageRow row;
  if (kind.has_rowid) row.rowid = static_cast<std::int64_t>(reader.varint());
  if (reader.has_failed() || size == 0 || size > kPayloadMax) return {};
  const Bytes here = reader.take(size_on_page(size, kind.has_rowid));
  if (reader.has_failed()) return {};
  std::vector<std::uint8_t> record{here.begin(), here.end()};
  if (record.size() < size) {
    const Bytes next = reader.take(4);
    if (next.empty() || !append_overflow(record, size, big_endian(next, 0, 4), page_of)) return {};
  }
  auto values = values_of(record);
  if (!values) return {};
  row.values = std::move(*values);
  return row;
}

/// SQLite's checksum of a log: pairs of words, in the byte order that the log's first word names.
struct LogSum {
  bool is_big_endian = false;
  std::uint32_t first = 0;
  std::uint32_t second = 0;

  void add(Bytes bytes) {
    for (std::size_t i = 0; i + 8 <= bytes.size(); i += 8) {
      first += word(bytes, i) + second;
      second += word(bytes, i + 4) + first;
    }
  }
  [[nodiscard]] bool is(Bytes stored, std::size_t at) const {
    return big_endian(stored, at, 4) == first && big_endian(stored, at + 4, 4) == second;
  }

 private:
  [[nodiscard]] std::uint32_t word(Bytes bytes, std::size_t at) const {
    const std::uint32_t value = big_endian(bytes, at, 4);
    return is_big_endian ? value : __builtin_bswap32(value);
  }
};

std::vector<std::uint8_t> read_at(std::ifstream& in, std::uint64_t at, std::size_t size) {
  std::vector<std::uint8_t> bytes(size);
  in.clear();
  in.seekg(static_cast<std::streamoff>(at));
  in.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(size));
  bytes.resize(static_cast<std::size_t>(std::max<std::streamsize>(in.gcount(), 0)));
  return bytes;
}

}  // namespace

std::vector<PageRow> rows_on_page(Bytes page, bool is_first, const PageOf& page_of) {
  const std::size_t begin = is_first ? 100 : 0;  // after the file's header
  if (page.size() < kPage) return {};
  const auto kind = kind_of(page[begin]);
  if (!kind) return {};
  const std::size_t cells = big_endian(page, begin + 3, 2);
  const std::size_t pointers = begin + (kind->is_leaf ? 8 : 12);
  std::vector<PageRow> rows;
  for (std::size_t i = 0; i < cells && pointers + 2 * i + 2 <= page.size(); ++i) {
    const std::size_t at = big_endian(page, pointers + 2 * i, 2);
    if (at < pointers || at >= page.size()) continue;
    if (auto row = row_of(page.subspan(at), *kind, page_of)) rows.push_back(std::move(*row));
  }
  return rows;
}

Result<PagedFile> PagedFile::open(const std::filesystem::path& file) {
  PagedFile paged;
  paged.file_ = file;
  paged.log_ = file.string() + "-wal";
  std::error_code error;
  const std::uintmax_t bytes = std::filesystem::file_size(file, error);
  if (error) {
    return failure(ErrorCode::io_failed,
                   fmt::format("'{}' cannot be read: {}", file.string(), error.message()));
  }
  paged.pages_ = static_cast<std::uint32_t>((bytes + kPage - 1) / kPage);
  TRY(paged.read_log());
  return paged;
}

/// Frames count up to the last one that ends a commit, as long as their checksums are right.
Result<void> PagedFile::read_log() {
  std::ifstream in{log_, std::ios::binary};
  if (!in) return {};  // most files have no log
  const auto header = read_at(in, 0, kLogHeader);
  if (header.size() < kLogHeader || big_endian(header, 8, 4) != kPage) return {};
  LogSum sum{.is_big_endian = (big_endian(header, 0, 4) & 1u) != 0};
  sum.add(Bytes{header}.first(24));
  if (!sum.is(header, 24)) return {};
  std::map<std::uint32_t, std::uint64_t> open;  // of a commit that has not ended
  for (std::uint64_t at = kLogHeader;; at += kFrameHeader + kPage) {
    const auto frame = read_at(in, at, kFrameHeader + kPage);
    if (frame.size() < kFrameHeader + kPage) return {};
    if (!std::equal(frame.begin() + 8, frame.begin() + 16, header.begin() + 16)) return {};
    sum.add(Bytes{frame}.first(8));
    sum.add(Bytes{frame}.subspan(kFrameHeader));
    if (!sum.is(frame, 16)) return {};
    open[big_endian(frame, 0, 4)] = at + kFrameHeader;
    if (big_endian(frame, 4, 4) == 0) continue;
    for (const auto& [page, place] : open) {
      in_log_[page] = place;
      pages_ = std::max(pages_, page);
    }
    open.clear();
  }
}

std::vector<std::uint8_t> PagedFile::page(std::uint32_t number) const {
  if (number == 0 || number > pages_) return {};
  const auto logged = in_log_.find(number);
  std::ifstream in{logged == in_log_.end() ? file_ : log_, std::ios::binary};
  const std::uint64_t at =
      logged == in_log_.end() ? (std::uint64_t{number} - 1) * kPage : logged->second;
  std::vector<std::uint8_t> bytes = read_at(in, at, kPage);
  if (bytes.empty()) return bytes;
  bytes.resize(kPage);  // the last page of a truncated file
  return bytes;
}

}  // namespace recald::sqlite
