#include "daemon/site/setup/file_guess.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <map>
#include <optional>

#include "adapters/csv/fields.hpp"
#include "adapters/csv/line_reader.hpp"
#include "adapters/table/cells/stamps.hpp"
#include "adapters/table/cells/words.hpp"
#include "adapters/table/clock_labels.hpp"
#include "adapters/table/delimited.hpp"
#include "adapters/table/files/open_rows.hpp"
#include "adapters/table/layouts/guess_layout.hpp"
#include "adapters/table/layouts/layout_rows.hpp"
#include "adapters/table/xlsx.hpp"
#include "core/text/utf8.hpp"

namespace recald::daemon {
namespace {

using std::chrono::seconds;
using table::Container;

constexpr std::size_t kSeparatorLines = 60;
constexpr std::size_t kSeparatorBytes = 8u << 20;
constexpr std::size_t kHeadCellsMax = 400'000;  // of wide tables fewer rows are kept
constexpr std::size_t kBlockRows = 200;
constexpr std::size_t kBlocksMax = 50;

std::vector<table::KeptRow> kept_head(table::RowSource& rows) {
  std::vector<table::KeptRow> kept;
  std::size_t cells = 0;
  for (table::TableRow row;
       kept.size() < table::kSniffedRows && cells < kHeadCellsMax && rows.next(row);) {
    kept.push_back({row.number, {}});
    for (const std::string_view cell : row.cells) {
      kept.back().cells.push_back(utf8_of(cell));
    }
    cells += row.cells.size();
  }
  return kept;
}

/// Exports that say their unit nowhere, by columns that only theirs have together.
struct KnownExport {
  std::array<std::string_view, 4> columns;  ///< As `folded` makes them.
  std::string_view unit;
  std::string_view of;
};
constexpr std::array kKnownExports{
    KnownExport{{" giorno ", " 00 00 00 15 ", " 00 15 00 30 ", " 23 45 24 00 "},
                "kWh",
                "as quarters of an hour of e-distribuzione are"},
    KnownExport{{" giorno ", " 00 00 00 15 ", " 00 15 00 30 ", " 23 45 00 00 "},
                "kWh",
                "as quarters of an hour of e-distribuzione are"},
    KnownExport{{" datum ", " ean ", " verbruik ", " piek "}, "kWh", "as exports of Engie are"},
};

/// A unit that no cell says, but the kind of export.
void take_known_unit(std::span<const table::KeptRow> head, table::TableGuess& guess) {
  const bool lacks_one =
      guess.shape.unit_column.empty() &&
      std::ranges::any_of(guess.values, [](const auto& value) { return value.unit.empty(); });
  if (!lacks_one) return;
  constexpr std::size_t kSearched = 20;
  for (const table::KeptRow& row : head.first(std::min(kSearched, head.size()))) {
    std::vector<std::string> cells;
    for (const std::string& cell : row.cells) cells.push_back(table::folded(cell));
    const auto has = [&](std::string_view column) {
      return std::ranges::find(cells, column) != cells.end();
    };
    const auto known = std::ranges::find_if(kKnownExports, [&](const KnownExport& one) {
      return std::ranges::all_of(one.columns, has);
    });
    if (known == kKnownExports.end()) continue;
    for (table::GuessedColumn& value : guess.values) {
      if (!value.unit.empty()) continue;
      value.unit = known->unit;
      value.unit_because = known->of;
    }
    return;
  }
}

Result<FileGuess> guess_rows(std::vector<table::KeptRow> head, const table::TableHints& hints) {
  if (const auto layout = table::guess_layout(head)) {
    auto guess = TRY(table::guess_table(layout->rows, hints));
    table::settle_layout(*layout, guess);
    take_known_unit(head, guess);
    return FileGuess{std::move(guess), layout->because, {}};
  }
  for (table::KeptRow& row : head) {
    if (row.cells.size() > table::kCellsMax) row.cells.resize(table::kCellsMax);
  }
  auto guess = TRY(table::guess_table(head, hints));
  take_known_unit(head, guess);
  return FileGuess{std::move(guess), "", {}};
}

/// The likely separator, and if it makes no table the others.
Result<FileGuess> guess_text(const std::filesystem::path& file, std::span<const std::string> lines,
                             const table::TableHints& hints) {
  const char likely = table::guess_separator(lines);
  std::optional<Error> first;
  for (const char separator : {likely, ';', '\t', ',', '|'}) {
    if (first && separator == likely) continue;
    auto bytes = TRY(csv::open_file(file, "export"));
    const auto rows = table::delimited_rows(std::move(bytes), separator, table::kWideRows);
    auto head = kept_head(*rows);
    if (rows->error()) return tl::unexpected(*rows->error());
    auto guess = guess_rows(std::move(head), hints);
    if (guess) {
      guess->table.shape.separator = separator;
      return guess;
    }
    if (!first) first = guess.error();
  }
  return tl::unexpected(*first);
}

Result<FileGuess> guess_opened(const std::filesystem::path& file, const table::TableShape& shape,
                               const table::TableHints& hints) {
  const auto rows = TRY(table::open_rows(file, shape));
  auto head = kept_head(*rows);
  if (rows->error()) return tl::unexpected(*rows->error());
  auto guess = guess_rows(std::move(head), hints);
  if (guess) {
    guess->table.shape.container = shape.container;
    guess->table.shape.sheet = shape.sheet;
  }
  return guess;
}

/// The commonest step of a table's first rows, of each meter by itself.
std::optional<seconds> usual_step(const std::filesystem::path& file,
                                  const table::TableShape& of_file) {
  const auto rows = table::open_rows(file, of_file);
  if (!rows) return {};
  const table::TableShape shape = table::shape_of_rows(of_file);
  std::optional<std::size_t> time;
  std::optional<std::size_t> clock;
  std::optional<std::size_t> meter;
  std::map<std::string, metering::Instant> last;
  std::map<seconds, int> steps;
  std::size_t seen = 0;
  for (table::TableRow row; seen < table::kSniffedRows && (*rows)->next(row); ++seen) {
    if (!time) {
      std::vector<std::string> header;
      for (const std::string_view cell : row.cells) header.push_back(utf8_of(cell));
      time = table::find_time_in_header(header, shape);
      clock = table::find_column(header, shape.clock_column);
      meter = table::find_column(header, shape.meter_column);
      if (!shape.time_column.starts_with('#')) continue;
    }
    const auto cell = [&](std::optional<std::size_t> at) {
      return at && *at < row.cells.size() ? row.cells[*at] : std::string_view{};
    };
    const auto written = table::parse_stamp(cell(time), shape.time_format);
    if (!written) continue;
    const metering::Instant stamp =
        written->clock + table::time_of_clock_cell(cell(clock), shape).value_or(seconds{0});
    const auto [before, is_new] = last.try_emplace(std::string{cell(meter)}, stamp);
    if (is_new) continue;
    const seconds step = std::max(stamp - before->second, before->second - stamp);
    if (step > seconds{0}) ++steps[step];
    before->second = stamp;
  }
  const auto most = std::ranges::max_element(steps, {}, [](const auto& one) { return one.second; });
  return most == steps.end() ? std::nullopt : std::optional{most->first};
}

std::string step_words(std::optional<seconds> step) {
  if (!step) return "no steps";
  const auto count = step->count();
  if (count % 86'400 == 0) {
    return count == 86'400 ? "a value a day" : fmt::format("a value in {} days", count / 86'400);
  }
  return count % 60 == 0 ? fmt::format("a value every {} min", count / 60)
                         : fmt::format("a value every {} s", count);
}

struct SheetGuess {
  std::string name;
  FileGuess guess;
  std::optional<seconds> step;

  /// A load profile before days and months, the finer one first.
  [[nodiscard]] std::pair<bool, seconds> rank() const {
    const bool is_profile = step && *step <= seconds{3600};
    return {!is_profile, step.value_or(seconds::max())};
  }
};

/// The sheet with the finest readings, the first of equals; the others are named.
Result<FileGuess> guess_workbook(const std::filesystem::path& file,
                                 const table::TableHints& hints) {
  const auto names = TRY(table::sheet_names(file));
  std::vector<SheetGuess> sheets;
  std::optional<Error> first;
  for (const std::string& name : names) {
    if (!hints.sheet.empty() && name != hints.sheet) continue;
    auto guess = guess_opened(file, {.container = Container::xlsx, .sheet = name}, hints);
    if (guess) {
      const auto step = usual_step(file, guess->table.shape);
      sheets.push_back({name, std::move(*guess), step});
    } else if (!first) {
      first = guess.error();
    }
  }
  if (sheets.empty()) {
    const std::string missing = hints.sheet.empty()
                                    ? "it has no sheet"
                                    : fmt::format("it has no sheet '{}'; it has '{}'", hints.sheet,
                                                  fmt::join(names, "', '"));
    return tl::unexpected(first.value_or(Error{ErrorCode::malformed, missing}));
  }
  const auto best = std::ranges::min_element(sheets, {}, &SheetGuess::rank);
  FileGuess chosen = best->guess;
  std::vector<std::string> others;
  for (const SheetGuess& sheet : sheets) {
    if (&sheet == &*best) continue;
    others.push_back(fmt::format("{} ({})", csv::in_quotes(sheet.name), step_words(sheet.step)));
  }
  if (!others.empty()) {
    chosen.notes.push_back(
        fmt::format("{}: sheet {} is read ({}); {} not: {}. For another one repeat the "
                    "[[meter]] with its 'sheet', or say --sheet.",
                    file.filename().string(), csv::in_quotes(best->name), step_words(best->step),
                    others.size() == 1 ? "one is" : "others are", fmt::join(others, ", ")));
  }
  return chosen;
}

std::vector<std::string> cells_as_texts(const table::TableRow& row) {
  std::vector<std::string> texts;
  for (const std::string_view cell : row.cells) texts.push_back(utf8_of(cell));
  return texts;
}

}  // namespace

Result<std::vector<std::string>> first_lines(const std::filesystem::path& file) {
  auto bytes = TRY(csv::open_file(file, "export"));
  csv::LineReader reader{table::as_utf8(std::move(bytes)), table::kWideRows.line_bytes};
  std::vector<std::string> lines;
  std::size_t size = 0;
  for (csv::Line line{};
       lines.size() < kSeparatorLines && size < kSeparatorBytes && reader.next(line);) {
    lines.emplace_back(line.text);
    size += line.text.size();
  }
  if (reader.error()) return tl::unexpected(*reader.error());
  return lines;
}

Result<FileGuess> guess_file(const std::filesystem::path& file, Container container,
                             std::span<const std::string> lines, const table::TableHints& hints) {
  if (container == Container::xlsx) return guess_workbook(file, hints);
  if (container == Container::json)
    return guess_opened(file, {.container = Container::json}, hints);
  return guess_text(file, lines, hints);
}

Result<std::vector<table::GuessedColumn>> columns_of_further_blocks(
    const std::filesystem::path& file, const table::TableShape& shape) {
  const auto rows = TRY(table::open_rows(file, shape));
  std::vector<std::string> first;
  std::optional<std::size_t> time;
  std::vector<std::vector<table::KeptRow>> blocks;
  bool is_in_block = false;
  for (table::TableRow row; rows->next(row);) {
    if (first.empty()) {
      auto header = cells_as_texts(row);
      time = table::find_time_in_header(header, shape);
      if (time) first = std::move(header);
      continue;
    }
    if (*time < row.cells.size() && row.cells[*time] == first[*time]) {
      is_in_block = cells_as_texts(row) != first && blocks.size() < kBlocksMax;
      if (is_in_block) blocks.emplace_back();
    }
    if (!is_in_block || blocks.back().size() == kBlockRows) continue;
    blocks.back().push_back({row.number, cells_as_texts(row)});
  }
  if (rows->error()) return tl::unexpected(*rows->error());
  std::vector<table::GuessedColumn> columns;
  for (const auto& block : blocks) {
    auto guess = table::guess_table(block);
    if (!guess || guess->shape.time_column != shape.time_column) continue;
    for (table::GuessedColumn& one : guess->values) {
      const bool is_known =
          std::ranges::find(first, one.column) != first.end() ||
          std::ranges::find(columns, one.column, &table::GuessedColumn::column) != columns.end();
      if (!is_known && !one.column.starts_with('#')) columns.push_back(std::move(one));
    }
  }
  return columns;
}

}  // namespace recald::daemon
