#include "adapters/table/containers/nem12.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "adapters/csv/fields.hpp"
#include "adapters/table/cells/stamps.hpp"
#include "adapters/table/delimited.hpp"
#include "adapters/table/sniff.hpp"
#include "core/metering/civil_time.hpp"
#include "core/text/utf8.hpp"

namespace recald::table {
namespace {

using metering::Instant;
using std::chrono::minutes;
using std::chrono::seconds;

constexpr seconds kMarketClock{10 * 3600};   // ahead of UTC, in summer as in winter
constexpr std::size_t kLeftOutMax = 20;      // channels that are named
constexpr std::string_view kOfRanges = "V";  // quality: see the 400 records

std::optional<int> whole(std::string_view text) {
  int value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size() || text.empty()) return {};
  return value;
}

class Nem12Rows final : public RowSource {
 public:
  explicit Nem12Rows(csv::ByteSource bytes) : lines_{delimited_rows(std::move(bytes), ',')} {}

  bool next(TableRow& row) override {
    if (!is_header_out_) return hand_out_header(row);
    while (at_ == values_.size()) {
      if (!next_day(row)) return false;
      if (is_problem_) return true;
    }
    hand_out(at_++, row);
    return true;
  }

  [[nodiscard]] const std::optional<Error>& error() const override {
    return error_ ? error_ : lines_->error();
  }

 private:
  [[nodiscard]] std::vector<std::string> said() const override {
    if (left_out_.empty()) return {};
    std::string words = "channels without energy are left out: ";
    for (const std::string& one : left_out_) words += (one == *left_out_.begin() ? "" : ", ") + one;
    return {std::move(words)};
  }

  bool hand_out_header(TableRow& row) {
    is_header_out_ = true;
    row = {};
    row.cells = {"timestamp", "meter", "value", "unit", "quality"};
    return true;
  }

  /// The next record, one that was read too far first.
  bool next_line() {
    if (std::exchange(is_ahead_, false)) return true;
    return lines_->next(line_);
  }

  [[nodiscard]] std::string_view cell(std::size_t index) const {
    return index < line_.cells.size() ? line_.cells[index] : std::string_view{};
  }

  /// Reads up to a day with values, and the ranges of quality behind it.
  /// @return false at the end; a line that cannot be used is handed out as a problem.
  bool next_day(TableRow& row) {
    is_problem_ = false;
    values_.clear();
    at_ = 0;
    while (next_line()) {
      const std::string_view record = cell(0);
      if (record == "100" && cell(1) == "NEM13") return refuse_nem13();
      if (record == "250") return refuse_nem13();
      if (record == "200") {
        begin_channel();
      } else if (record == "300" && is_channel_used_) {
        if (!begin_day()) return hand_out_problem(row);
        read_ranges();
        return true;
      }
    }
    return false;
  }

  bool refuse_nem13() {
    error_.emplace(ErrorCode::malformed,
                   "it is NEM13, registers that were read every few months; recald needs the "
                   "interval data, NEM12");
    return false;
  }

  bool hand_out_problem(TableRow& row) {
    is_problem_ = true;
    row.number = line_.number;
    row.text = line_.text;
    row.problem = problem_;
    row.is_terminated = true;
    row.cells.clear();
    return true;
  }

  void begin_channel() {
    const std::string_view suffix = cell(4).empty() ? cell(3) : cell(4);
    meter_ = utf8_of(cell(1)) + " / " + utf8_of(suffix);
    unit_ = cell(7);
    interval_min_ = whole(cell(8)).value_or(0);
    is_channel_used_ = is_unit(unit_);
    if (!is_channel_used_ && left_out_.size() < kLeftOutMax) {
      left_out_.insert(meter_ + " (" + utf8_of(unit_) + ")");
    }
  }

  bool begin_day() {
    const auto refuse = [&](const std::string& why) {
      problem_ = why;
      return false;
    };
    if (interval_min_ < 1 || interval_min_ > 60 || 60 % interval_min_ != 0) {
      return refuse("the 200 record before it does not say an interval in minutes");
    }
    const auto date = parse_stamp(cell(1), TimeFormat::year_first);
    if (!date || cell(1).size() != 8) {
      return refuse("date " + csv::in_quotes(cell(1)) + " is not yyyymmdd");
    }
    const auto count = static_cast<std::size_t>(1440 / interval_min_);
    if (line_.cells.size() < count + 3) {
      return refuse("the day has fewer than " + std::to_string(count) + " values");
    }
    begin_ = date->clock - kMarketClock;
    number_ = line_.number;
    text_.assign(line_.text);
    values_.resize(count);
    for (std::size_t i = 0; i < count; ++i) {
      values_[i] = {std::string{cell(2 + i)}, std::string{cell(2 + count).substr(0, 1)}};
    }
    return true;
  }

  /// 400 records: from interval to interval, counted from 1, with a quality of their own.
  void read_ranges() {
    while (next_line()) {
      if (cell(0) != "400") {
        is_ahead_ = true;
        return;
      }
      const auto first = whole(cell(1));
      const auto last = whole(cell(2));
      if (!first || !last || *first < 1) continue;
      for (auto i = static_cast<std::size_t>(*first);
           i <= values_.size() && i <= static_cast<std::size_t>(std::max(*last, 0)); ++i) {
        values_[i - 1].quality = cell(3).substr(0, 1);
      }
    }
  }

  void hand_out(std::size_t i, TableRow& row) {
    const Interval& one = values_[i];
    stamp_ = metering::to_string(begin_ + static_cast<int>(i) * minutes{interval_min_});
    row.number = number_;
    row.text = text_;
    row.problem = {};
    row.is_terminated = true;
    const bool is_null = one.quality.starts_with('N');
    row.cells = {stamp_, meter_, is_null ? std::string_view{} : one.value, unit_,
                 one.quality == kOfRanges ? std::string_view{} : one.quality};
  }

  struct Interval {
    std::string value;
    std::string quality;  ///< Without the number of its method.
  };

  std::unique_ptr<RowSource> lines_;
  TableRow line_;
  bool is_ahead_ = false;
  bool is_header_out_ = false;
  std::string meter_;
  std::string unit_;
  int interval_min_ = 0;
  bool is_channel_used_ = false;
  Instant begin_{};
  std::uint64_t number_ = 0;
  std::string text_;
  std::vector<Interval> values_;
  std::size_t at_ = 0;
  bool is_problem_ = false;
  std::string problem_;
  std::string stamp_;
  std::set<std::string> left_out_;
  std::optional<Error> error_;
};

}  // namespace

bool is_nem12(std::string_view first_line) {
  constexpr std::ptrdiff_t kCommas = 8;  // of a 200 record, which may come first
  return first_line.starts_with("100,NEM1") ||
         (first_line.starts_with("200,") &&
          std::count(first_line.begin(), first_line.end(), ',') >= kCommas);
}

std::unique_ptr<RowSource> nem12_rows(csv::ByteSource bytes) {
  return std::make_unique<Nem12Rows>(std::move(bytes));
}

}  // namespace recald::table
