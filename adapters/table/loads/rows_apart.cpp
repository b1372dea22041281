#include "adapters/table/loads/rows_apart.hpp"

#include <algorithm>
#include <array>
#include <map>

#include "adapters/table/cells/cell_number.hpp"
#include "adapters/table/cells/stamps.hpp"
#include "adapters/table/clock_labels.hpp"
#include "adapters/table/delimited.hpp"
#include "adapters/table/read_table.hpp"
#include "adapters/table/sniff.hpp"
#include "core/text/ascii.hpp"
#include "core/text/utf8.hpp"

namespace recald::table {
namespace {

using metering::Instant;

constexpr std::size_t kGroupsMax = 100;    // of one column, or of several together
constexpr std::size_t kColumnsChosen = 3;  // at most
constexpr std::size_t kStepsFree = 8;      // of each group: the hour that a clock shows twice
constexpr std::size_t kStepsShare = 500;   // one in so many may be wrong besides

/// Words in the names of columns that say how a value came about, not of which meter it is.
bool says_how(std::string_view name) {
  constexpr std::array<std::string_view, 19> kWords{
      "status", "quality", "flag",   "estim",  "note",   "remark", "comment",
      "valid",  "kwalit",  "qualit", "statut", "estado", "estado", "stato",
      "zust",   "geschat", "source", "bron",   "reason"};
  const std::string lower = to_lower(name);
  return std::ranges::any_of(
      kWords, [&](std::string_view word) { return lower.find(word) != std::string::npos; });
}

bool names_a_meter(std::string_view name) {
  constexpr std::array<std::string_view, 12> kWords{"meter", "point", "register", "channel",
                                                    "name",  "ean",   "mpan",     "mprn",
                                                    "cups",  "pod",   "obis",     "title"};
  const std::string lower = to_lower(name);
  return std::ranges::any_of(
      kWords, [&](std::string_view word) { return lower.find(word) != std::string::npos; });
}

/// How the times of one group's rows follow each other.
struct GroupOrder {
  std::optional<Instant> last;
  std::size_t rows = 0;
  std::size_t same = 0;
  std::size_t rises = 0;
  std::size_t falls = 0;
  std::size_t far_rises = 0;  ///< By more than a clock is changed.
  std::size_t far_falls = 0;

  void take(Instant stamp) {
    constexpr std::chrono::hours kFar{2};
    ++rows;
    if (last && stamp == *last) ++same;
    if (last && stamp > *last) ++rises;
    if (last && stamp < *last) ++falls;
    if (last && stamp > *last + kFar) ++far_rises;
    if (last && stamp < *last - kFar) ++far_falls;
    last = stamp;
  }

  /// Steps back in time by more than a clock is changed, as where another meter begins.
  [[nodiscard]] std::size_t far() const { return rises >= falls ? far_falls : far_rises; }

  /// Steps that a sound record does not have, old to new or new to old.
  [[nodiscard]] std::size_t wrong() const {
    const bool is_rising = rises >= falls;
    const std::size_t far = this->far();
    const std::size_t all = same + (is_rising ? falls : rises);
    return far + (all - far) - std::min(all - far, kStepsFree);
  }
};

/// A column, with those that are already chosen.
struct CandidateColumn {
  std::size_t place = 0;
  std::string column;
  std::string name;
  bool is_text = false;
  bool is_out = false;  ///< Too many different texts.
  std::map<std::string, GroupOrder, std::less<>> groups{};

  [[nodiscard]] std::size_t wrong() const {
    std::size_t all = 0;
    for (const auto& [text, group] : groups) all += group.wrong();
    return all;
  }
  [[nodiscard]] std::size_t far() const {
    std::size_t all = 0;
    for (const auto& [text, group] : groups) all += group.far();
    return all;
  }
  [[nodiscard]] bool is_sound(std::size_t rows) const {
    const bool has_rows =
        std::ranges::all_of(groups, [](const auto& one) { return one.second.rows > kStepsFree; });
    return groups.size() > 1 && has_rows && wrong() * kStepsShare <= rows;
  }
};

class ApartSearch {
 public:
  ApartSearch(const TableShape& shape, std::span<const std::string> values)
      : shape_{shape}, values_{values.begin(), values.end()} {}

  /// One pass over the rows, each column together with the chosen ones.
  Result<void> pass(RowSource& source) {
    columns_.clear();
    rows_ = 0;
    time_.reset();
    for (TableRow row; source.next(row);) {
      if (!time_) {
        find_places(row);
        if (!shape_.time_column.starts_with('#')) continue;
      }
      const auto stamp = stamp_of(row);
      if (!stamp) continue;
      ++rows_;
      for (CandidateColumn& column : columns_) take(column, row, *stamp);
    }
    if (source.error()) return tl::unexpected(*source.error());
    return {};
  }

  /// The column that solves it: the one with the fewest steps back, the fewest groups, then the one
  /// that names meters, then the one with words.
  [[nodiscard]] const CandidateColumn* solution() const {
    const CandidateColumn* best = nullptr;
    for (const CandidateColumn& one : columns_) {
      if (one.is_out || !one.is_sound(rows_)) continue;
      if (best == nullptr || is_better(one, *best)) best = &one;
    }
    return best;
  }

  /// The column that helps most; null if none helps.
  [[nodiscard]] const CandidateColumn* best_step() const {
    const CandidateColumn* best = nullptr;
    for (const CandidateColumn& one : columns_) {
      if (one.is_out || one.groups.size() < 2) continue;
      if (best == nullptr || one.wrong() < best->wrong()) best = &one;
    }
    return best;
  }

  /// Columns with no more groups than these.
  [[nodiscard]] std::vector<std::string> alike(std::size_t groups) const {
    std::vector<std::string> columns;
    for (const CandidateColumn& one : columns_) {
      if (!one.is_out && one.groups.size() <= groups) columns.push_back(one.column);
    }
    return columns;
  }

  void choose(const CandidateColumn& column) {
    chosen_.push_back(column.place);
    names_.push_back(column.column);
  }
  [[nodiscard]] const std::vector<std::string>& names() const { return names_; }

 private:
  static bool is_better(const CandidateColumn& a, const CandidateColumn& b) {
    if (a.far() != b.far()) return a.far() < b.far();
    if (a.groups.size() != b.groups.size()) return a.groups.size() < b.groups.size();
    if (a.is_text != b.is_text) return a.is_text;
    return names_a_meter(a.name) && !names_a_meter(b.name);
  }

  static std::string_view cell(const TableRow& row, std::size_t place) {
    return place < row.cells.size() ? row.cells[place] : std::string_view{};
  }

  void find_places(const TableRow& row) {
    std::vector<std::string> header;
    for (const std::string_view one : row.cells) header.push_back(utf8_of(one));
    time_ = find_time_in_header(header, shape_);
    if (!time_) return;
    clock_ = shape_.clock_column.empty() ? std::nullopt : find_column(header, shape_.clock_column);
    const bool has_header = !shape_.time_column.starts_with('#');
    for (std::size_t i = 0; i < header.size(); ++i) {
      if (i == *time_ || i == clock_) continue;
      std::string column = has_header ? header[i] : "";
      const bool is_first = find_column(header, column) == i;
      if (column.empty() || !is_first) column = "#" + std::to_string(i + 1);
      const bool is_value = std::ranges::find(values_, column) != values_.end();
      const bool is_chosen = std::ranges::find(chosen_, i) != chosen_.end();
      if (is_value || is_chosen || column == shape_.unit_column) continue;
      if (has_header && says_how(header[i])) continue;
      columns_.push_back({.place = i, .column = column, .name = has_header ? header[i] : ""});
    }
  }

  [[nodiscard]] std::optional<Instant> stamp_of(const TableRow& row) const {
    const auto written = parse_stamp(cell(row, *time_), shape_.time_format);
    if (!written) return {};
    const Instant stamp = written->clock - written->utc_offset.value_or(std::chrono::seconds{0});
    if (!clock_) return stamp;
    const auto time = time_of_clock_cell(cell(row, *clock_), shape_);
    return time ? std::optional{stamp + *time} : std::nullopt;
  }

  void take(CandidateColumn& column, const TableRow& row, Instant stamp) {
    if (column.is_out) return;
    key_.assign(cell(row, column.place));
    const bool is_number = possible_decimal_signs(key_).point || possible_decimal_signs(key_).comma;
    if (!key_.empty() && !is_number) column.is_text = true;
    for (const std::size_t place : chosen_) {
      key_ += '\x1f';
      key_ += cell(row, place);
    }
    const auto known = column.groups.find(key_);
    if (known != column.groups.end()) return known->second.take(stamp);
    if (column.groups.size() == kGroupsMax) {
      column.is_out = true;
      return;
    }
    column.groups[key_].take(stamp);
  }

  const TableShape& shape_;
  std::vector<std::string> values_;
  std::vector<CandidateColumn> columns_;
  std::vector<std::size_t> chosen_;
  std::vector<std::string> names_;
  std::optional<std::size_t> time_;
  std::optional<std::size_t> clock_;
  std::size_t rows_ = 0;
  std::string key_;
};

}  // namespace

Result<std::optional<ColumnsApart>> columns_that_tell_apart(
    const std::function<Result<std::unique_ptr<RowSource>>()>& open, const TableShape& shape,
    std::span<const std::string> values) {
  ApartSearch search{shape, values};
  for (std::size_t i = 0; i < kColumnsChosen; ++i) {
    const auto rows = TRY(open());
    TRY(search.pass(*rows));
    if (const CandidateColumn* found = search.solution()) {
      ColumnsApart apart{{}, found->groups.size(), search.alike(found->groups.size())};
      search.choose(*found);
      apart.columns = search.names();
      return apart;
    }
    const CandidateColumn* step = search.best_step();
    if (step == nullptr) break;
    search.choose(*step);
  }
  return std::nullopt;
}

}  // namespace recald::table
