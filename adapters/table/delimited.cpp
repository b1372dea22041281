#include "adapters/table/delimited.hpp"

#include <algorithm>
#include <array>
#include <deque>
#include <memory>

#include "adapters/csv/fields.hpp"
#include "adapters/table/cells/words.hpp"
#include "core/text/utf8.hpp"

namespace recald::table {
namespace {

/// Without blanks of any width and unseen marks at both ends.
std::string_view without_wide_blanks(std::string_view cell) {
  const auto is_edge = [](std::uint32_t point) {
    return point == ' ' || is_wide_blank(point) || is_unseen(point);
  };
  for (std::string_view rest = cell; !rest.empty(); cell = rest) {
    if (!is_edge(take_character(rest))) break;
  }
  for (;;) {
    std::size_t begin = cell.size();  // of the last character
    while (begin > 0 && (static_cast<unsigned char>(cell[begin - 1]) & 0xC0u) == 0x80u) --begin;
    if (begin == 0) return cell;
    std::string_view last = cell.substr(begin - 1);
    if (!is_edge(take_character(last))) return cell;
    cell = cell.substr(0, begin - 1);
  }
}

/// Detects the encoding from the first bytes, then converts the whole text.
class Recoder {
 public:
  explicit Recoder(csv::ByteSource bytes) : bytes_{std::move(bytes)} {}

  Result<std::size_t> read(char* buffer, std::size_t size) {
    while (out_at_ == out_.size()) {
      out_.clear();
      out_at_ = 0;
      const auto got = bytes_(raw_.data(), raw_.size());
      if (!got || *got == 0) return got;
      take({raw_.data(), *got});
    }
    const std::size_t count = std::min(size, out_.size() - out_at_);
    std::copy_n(out_.data() + out_at_, count, buffer);
    out_at_ += count;
    return count;
  }

 private:
  enum class Kind { unknown, plain, little, big };

  void take(std::string_view piece) {
    if (kind_ == Kind::unknown) {
      begin_ += piece;
      if (begin_.size() < 2) return;
      const auto first = static_cast<unsigned char>(begin_[0]);
      const auto second = static_cast<unsigned char>(begin_[1]);
      const bool has_mark = (first == 0xFF && second == 0xFE) || (first == 0xFE && second == 0xFF);
      // Without a mark: a text begins with a letter, of which one byte is zero.
      kind_ = first == 0xFF && second == 0xFE   ? Kind::little
              : first == 0xFE && second == 0xFF ? Kind::big
              : second == 0                     ? Kind::little
              : first == 0                      ? Kind::big
                                                : Kind::plain;
      const std::string whole = std::move(begin_);
      take(std::string_view{whole}.substr(has_mark ? 2 : 0));
      return;
    }
    if (kind_ == Kind::plain) {
      out_ += piece;
    } else {
      for (const char c : piece) take_byte(static_cast<unsigned char>(c));
    }
    if (!are_ends_known_ && !out_.empty()) {
      are_ends_known_ = true;
      const std::size_t at = out_.find('\r');
      has_old_ends_ = at < out_.size() - 1 && out_.find('\n') == std::string::npos;
    }
    if (has_old_ends_) std::replace(out_.begin(), out_.end(), '\r', '\n');
  }

  void take_byte(unsigned char byte) {
    if (!half_) {
      half_ = byte;
      return;
    }
    const std::uint32_t unit = kind_ == Kind::little
                                   ? static_cast<std::uint32_t>(byte) << 8 | *half_
                                   : static_cast<std::uint32_t>(*half_) << 8 | byte;
    half_.reset();
    if (unit >= 0xD800 && unit < 0xDC00) {
      high_ = unit;
    } else if (unit >= 0xDC00 && unit < 0xE000) {
      if (high_) append_utf8(out_, 0x10000 + ((*high_ - 0xD800) << 10) + (unit - 0xDC00));
      high_.reset();
    } else {
      append_utf8(out_, unit);
    }
  }

  csv::ByteSource bytes_;
  Kind kind_ = Kind::unknown;
  std::string begin_;
  std::array<char, 64 * 1024> raw_{};
  std::string out_;
  std::size_t out_at_ = 0;
  std::optional<unsigned char> half_;
  std::optional<std::uint32_t> high_;
  bool are_ends_known_ = false;
  bool has_old_ends_ = false;  ///< Lines end in a carriage return alone.
};

enum class Split : std::uint8_t { whole, open, bad };

/// Reads a quoted cell after its opening quote. @return false: the quote is never closed
bool take_quoted(std::string_view& line, std::string& unquoted) {
  for (;;) {
    const std::size_t quote = line.find('"');
    if (quote == std::string_view::npos) return false;
    unquoted.append(line.substr(0, quote));
    line.remove_prefix(quote + 1);
    if (line.empty() || line.front() != '"') return true;
    unquoted += '"';
    line.remove_prefix(1);
  }
}

/// A cell without blanks of any width at its ends, and out of the formula that keeps a spreadsheet
/// from reading a number: ="0123".
std::string_view cleaned(std::string_view cell) {
  cell = csv::trimmed(cell);
  const auto is_ascii = [](char c) { return static_cast<unsigned char>(c) < 0x80; };
  if (cell.empty()) return cell;
  if (!is_ascii(cell.front()) || !is_ascii(cell.back())) cell = without_wide_blanks(cell);
  if (cell.size() >= 3 && cell.front() == '=' && cell[1] == '"' && cell.back() == '"') {
    return cell.substr(2, cell.size() - 3);
  }
  return cell;
}

Split cut_line(std::string_view line, char separator, std::vector<std::string_view>& cells,
               std::string& unquoted, std::size_t cells_max) {
  // Contents are never longer than the line, so reserving once keeps earlier cells valid.
  unquoted.clear();
  unquoted.reserve(line.size());
  while (cells.size() < cells_max) {
    while (!line.empty() && line.front() == ' ') line.remove_prefix(1);
    if (!line.empty() && line.front() == '"') {
      line.remove_prefix(1);
      const std::size_t begin = unquoted.size();
      if (!take_quoted(line, unquoted)) return Split::open;
      cells.push_back(cleaned(std::string_view{unquoted}.substr(begin)));
      while (!line.empty() && line.front() == ' ') line.remove_prefix(1);
      if (line.empty()) return Split::whole;
      if (line.front() != separator) return Split::bad;
      line.remove_prefix(1);
      continue;
    }
    const std::size_t length = std::min(line.find(separator), line.size());
    cells.push_back(cleaned(line.substr(0, length)));
    if (length == line.size()) return Split::whole;
    line.remove_prefix(length + 1);
  }
  return Split::whole;
}

/// Rows of text. A row with a line break inside quotes is put together from its lines, within
/// bounds: a quote that is never closed must cost no more than its own line.
class DelimitedRows final : public RowSource {
 public:
  DelimitedRows(csv::ByteSource bytes, char separator, const RowLimits& limits)
      : lines_{as_utf8(std::move(bytes)), limits.line_bytes},
        separator_{separator},
        limits_{limits} {}

  bool next(TableRow& row) override {
    csv::Line line{};
    if (!next_line(line)) return false;
    row.number = line.number;
    row.text = line.text;
    row.is_terminated = line.terminated;
    row.problem = {};
    if (line.too_long) {
      row.cells.clear();
      row.problem = limits_.line_bytes > csv::kLineMax ? "longer than 2 MiB" : "longer than 64 KiB";
      return true;
    }
    Split split = cut(line.text, row.cells);
    if (split == Split::open) {
      const bool is_joined = join_lines(line);
      row.text = is_joined ? std::string_view{joined_} : line.text;
      if (is_joined) row.is_terminated = is_joined_terminated_;
      if (is_joined) split = cut(joined_, row.cells);
    }
    if (split == Split::whole) return true;
    row.cells.clear();
    row.problem = "a quote is not closed, or text follows a closing quote";
    return true;
  }

  [[nodiscard]] const std::optional<Error>& error() const override { return lines_.error(); }

 private:
  static constexpr std::size_t kJoinedMax = 20;  // lines of one row

  struct WaitingLine {
    std::string text;
    csv::Line line;
  };

  Split cut(std::string_view text, std::vector<std::string_view>& cells) {
    cells.clear();
    return cut_line(text, separator_, cells, unquoted_, limits_.cells);
  }

  bool next_line(csv::Line& line) {
    if (waiting_.empty()) return lines_.next(line);
    shown_ = std::move(waiting_.front());
    waiting_.pop_front();
    line = shown_.line;
    line.text = shown_.text;
    return true;
  }

  /// Adds lines to `joined_` until its quotes are closed. @return false: they are not, and all
  /// lines but the first wait for the next call
  bool join_lines(csv::Line& first) {
    joined_ = first.text;
    first_text_ = first.text;
    first.text = first_text_;
    std::vector<std::string_view> cells;
    std::string unquoted;
    for (std::size_t used = 0; used < kJoinedMax && joined_.size() < csv::kLineMax; ++used) {
      if (used == waiting_.size()) {
        csv::Line line{};
        if (!lines_.next(line)) return false;
        waiting_.push_back({std::string{line.text}, line});
      }
      const WaitingLine& more = waiting_[used];
      if (more.line.too_long) return false;
      joined_ += ' ';
      joined_ += more.text;
      if (more.text.find('"') == std::string::npos) continue;
      cells.clear();
      const Split split = cut_line(joined_, separator_, cells, unquoted, limits_.cells);
      if (split == Split::bad) return false;
      if (split == Split::open) continue;
      is_joined_terminated_ = more.line.terminated;
      waiting_.erase(waiting_.begin(), waiting_.begin() + static_cast<std::ptrdiff_t>(used) + 1);
      return true;
    }
    return false;
  }

  csv::LineReader lines_;
  char separator_;
  RowLimits limits_;
  std::string unquoted_;
  std::string joined_;
  std::string first_text_;
  bool is_joined_terminated_ = true;
  std::deque<WaitingLine> waiting_;
  WaitingLine shown_;
};

}  // namespace

bool split_cells(std::string_view line, char separator, std::vector<std::string_view>& cells,
                 std::string& unquoted, std::size_t cells_max) {
  return cut_line(line, separator, cells, unquoted, cells_max) == Split::whole;
}

std::unique_ptr<RowSource> delimited_rows(csv::ByteSource bytes, char separator,
                                          const RowLimits& limits) {
  return std::make_unique<DelimitedRows>(std::move(bytes), separator, limits);
}

csv::ByteSource as_utf8(csv::ByteSource bytes) {
  const auto recoder = std::make_shared<Recoder>(std::move(bytes));
  return [recoder](char* buffer, std::size_t size) { return recoder->read(buffer, size); };
}

}  // namespace recald::table
