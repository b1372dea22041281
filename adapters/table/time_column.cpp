#include "adapters/table/time_column.hpp"

#include <algorithm>
#include <set>

#include "adapters/table/cells/cell_number.hpp"
#include "adapters/table/cells/words.hpp"

namespace recald::table {
namespace {

constexpr std::size_t kRowsCompared = 10;

std::size_t cells_filled(const KeptRow& row) {
  return static_cast<std::size_t>(std::count_if(
      row.cells.begin(), row.cells.end(), [](const std::string& cell) { return !cell.empty(); }));
}

/// The first row with a time that others follow, with about as many cells: not a date in the lines
/// above the table.
std::optional<std::size_t> first_of_data(std::span<const KeptRow* const> rows, std::size_t column) {
  std::vector<std::size_t> dated;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (is_date(cell_of(*rows[i], column))) dated.push_back(i);
  }
  if (dated.empty()) return {};
  std::vector<std::size_t> widths;
  for (const std::size_t i : dated) widths.push_back(cells_filled(*rows[i]));
  std::nth_element(widths.begin(), widths.begin() + static_cast<std::ptrdiff_t>(widths.size() / 2),
                   widths.end());
  const std::size_t usual = widths[widths.size() / 2];
  for (std::size_t k = 0; k < dated.size(); ++k) {
    const std::size_t ahead = std::min(kRowsCompared, dated.size() - k);
    const bool is_run = dated[k + ahead - 1] - dated[k] <= ahead;
    const bool is_next = k + 1 == dated.size() || dated[k + 1] == dated[k] + 1;
    if (is_run && is_next && 5 * cells_filled(*rows[dated[k]]) >= 3 * usual) return dated[k];
  }
  return dated.front();
}

struct Candidate {
  std::size_t column;
  std::size_t first_row;
  std::size_t different;
  int rank;  ///< By its header: starts before times before ends before when rows were written.
};

constexpr int kWritten = 3;  // the rank of times at which rows were written or changed

int rank_of(std::string_view header) {
  const Meanings meanings = meanings_of(header);
  if (meanings.has(Meaning::other_time)) return kWritten;
  if (meanings.has(Meaning::from)) return 0;
  return meanings.has(Meaning::to) ? 2 : 1;
}

std::optional<TimeColumn> find_dated(std::span<const KeptRow* const> rows, std::size_t width,
                                     std::optional<std::size_t> told) {
  std::vector<Candidate> candidates;
  for (std::size_t column = 0; column < width; ++column) {
    if (told && column != *told) continue;
    const auto first = first_of_data(rows, column);
    if (!first) continue;
    std::set<std::string_view> different;
    std::size_t count = 0;
    for (const KeptRow* row : rows.subspan(*first)) {
      const std::string_view cell = cell_of(*row, column);
      if (!is_date(cell)) continue;
      ++count;
      different.insert(cell);
    }
    if (2 * count < rows.size() - *first) continue;
    // Of seconds since 1970 some, such as 1604197800, read as dates.
    const auto counted = std::ranges::count_if(rows.first(*first), [&](const KeptRow* row) {
      return parse_cell(cell_of(*row, column), '.').has_value();
    });
    if (static_cast<std::size_t>(counted) > count) continue;
    candidates.push_back(
        {column, *first, different.size(), rank_of(text_above(rows, *first, column))});
  }
  if (candidates.empty()) return {};
  const auto is_of_rows = [](const Candidate& one) { return one.rank < kWritten; };
  if (std::any_of(candidates.begin(), candidates.end(), is_of_rows)) {
    std::erase_if(candidates, [&](const Candidate& one) { return !is_of_rows(one); });
  }
  const std::size_t most = std::max_element(candidates.begin(), candidates.end(),
                                            [](const Candidate& a, const Candidate& b) {
                                              return a.different < b.different;
                                            })
                               ->different;
  std::erase_if(candidates, [&](const Candidate& one) { return 2 * one.different < most; });
  const auto best =
      std::min_element(candidates.begin(), candidates.end(),
                       [](const Candidate& a, const Candidate& b) { return a.rank < b.rank; });
  return TimeColumn{best->column, best->first_row, false, TimeFormat::year_first};
}

struct Counts {
  std::vector<double> values;
  std::size_t first_row = 0;
};

Counts counts_of(std::span<const KeptRow* const> rows, std::size_t column) {
  Counts counts;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const std::string_view cell = cell_of(*rows[i], column);
    auto count = parse_cell(cell, '.');
    if (!count) count = parse_cell(cell, ',');
    if (!count) continue;
    if (counts.values.empty()) counts.first_row = i;
    counts.values.push_back(*count);
  }
  return counts;
}

/// The step that most neighbours have; 0: none.
double commonest_step_of(const std::vector<double>& values) {
  std::vector<double> steps;
  for (std::size_t i = 1; i < values.size(); ++i) {
    if (values[i] > values[i - 1]) steps.push_back(values[i] - values[i - 1]);
  }
  std::sort(steps.begin(), steps.end());
  double step = 0.0;
  std::size_t most = 0;
  for (std::size_t begin = 0; begin < steps.size();) {
    std::size_t end = begin;
    while (end < steps.size() && steps[end] <= steps[begin] * (1.0 + 1e-5)) ++end;
    if (end - begin > most) {
      most = end - begin;
      step = steps[begin];
    }
    begin = end;
  }
  return 2 * most >= steps.size() ? step : 0.0;
}

/// Whether the values rise, or fall, but for a few turns back: a table of one meter after another
/// begins again with each. Falling ones are turned round.
bool make_rising(std::vector<double>& values) {
  constexpr std::size_t kRowsATurn = 20;
  std::size_t rises = 0;
  std::size_t falls = 0;
  for (std::size_t i = 1; i < values.size(); ++i) {
    if (values[i] > values[i - 1]) ++rises;
    if (values[i] < values[i - 1]) ++falls;
  }
  if (falls > rises) {
    std::reverse(values.begin(), values.end());
    std::swap(falls, rises);
  }
  return falls * kRowsATurn <= rises;
}

/// Days of a spreadsheet, or seconds since 1970 or parts of them: numbers that rise or fall, mostly
/// by the same step.
std::optional<TimeColumn> find_counted(std::span<const KeptRow* const> rows, std::size_t column) {
  Counts counts = counts_of(rows, column);
  std::vector<double>& values = counts.values;
  if (values.size() < 3 || values.size() + counts.first_row < rows.size() * 9 / 10) return {};
  if (!make_rising(values)) return {};
  constexpr double kLatest_s =
      static_cast<double>(metering::kLatestInstant.time_since_epoch().count());
  constexpr double kLatestDay = 25'569.0 + kLatest_s / 86'400.0;  // since the end of 1899
  const auto [least, most] = std::ranges::minmax_element(values);
  const double begin = *least;
  const double end = *most;
  const double step = std::ranges::is_sorted(values)
                          ? (end - begin) / static_cast<double>(values.size() - 1)
                          : commonest_step_of(values);
  if (begin > 32'000.0 && end < kLatestDay && step > 0.0 && step < 1.01) {
    return TimeColumn{column, counts.first_row, true, TimeFormat::excel};
  }
  for (const double unit : {1.0, 1e3, 1e6, 1e9}) {
    const double common = commonest_step_of(values) / unit;
    if (begin > 6e8 * unit && end < kLatest_s * unit && common >= 1.0 && common < 90'000.0) {
      return TimeColumn{column, counts.first_row, true, TimeFormat::unix};
    }
  }
  return {};
}

}  // namespace

std::string_view text_above(std::span<const KeptRow* const> rows, std::size_t first_row,
                            std::size_t column) {
  for (std::size_t i = first_row; i > 0; --i) {
    const std::string_view cell = cell_of(*rows[i - 1], column);
    if (!cell.empty() && !is_date(cell)) return cell;
  }
  return {};
}

std::optional<TimeColumn> find_time_column(std::span<const KeptRow* const> rows, std::size_t width,
                                           std::optional<std::size_t> told) {
  if (auto dated = find_dated(rows, width, told)) return dated;
  for (std::size_t column = 0; column < width; ++column) {
    if (told && column != *told) continue;
    if (auto counted = find_counted(rows, column)) return counted;
  }
  return {};
}

}  // namespace recald::table
