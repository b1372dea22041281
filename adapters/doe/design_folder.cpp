#include "adapters/doe/design_folder.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <span>

#include "adapters/doe/failed_runs_file.hpp"
#include "adapters/doe/priors_file.hpp"
#include "adapters/doe/table_reader.hpp"
#include "core/absent.hpp"

namespace recald::doe {
namespace {

namespace fs = std::filesystem;

// Files round their numbers, so a value may lie this far outside its prior.
constexpr double kRounding = 1e-4;

/// Calls `read(table)` for each row. Success, or the first error of the table or of `read`.
template <class ReadRow>
Result<void> for_each_row(TableReader& table, const ReadRow& read) {
  for (;;) {
    const auto more = TRY(table.next());
    if (!more) return {};
    if (Result<void> ok = read(); !ok) return ok;
  }
}

void note_open_end(const TableReader& table, std::vector<std::string>& notes) {
  if (!table.ends_open()) return;
  notes.push_back(
      fmt::format("'{}' ends without a line end: if the file was cut, its last number is wrong.",
                  table.file().string()));
}

Result<DesignMonth> read_month(const TableReader& table, std::size_t column) {
  auto month = DesignMonth::parse(table.text(column));
  if (!month) return table.wrong(month.error().message);
  return month;
}

std::string texts(std::span<const DesignMonth> months) {
  std::vector<std::string> names;
  for (const DesignMonth month : months) names.push_back(month.text());
  return listed(names);
}

std::string texts(std::span<const int> runs) {
  std::vector<std::string> names;
  for (const int run : runs) names.push_back(std::to_string(run));
  return listed(names);
}

/// The columns of a table that hold numbers.
struct ValueColumns {
  std::vector<std::size_t> columns;
  std::vector<std::string> names;
};

/// All columns except those in `keys`, which must all be there.
Result<ValueColumns> columns_beside(const TableReader& table,
                                    std::span<const std::string_view> keys) {
  for (const std::string_view key : keys) {
    TRY(table.require(key));
  }
  ValueColumns beside;
  for (std::size_t i = 0; i < table.columns().size(); ++i) {
    if (std::ranges::find(keys, table.columns()[i]) != keys.end()) continue;
    beside.columns.push_back(i);
    beside.names.push_back(table.columns()[i]);
  }
  if (!beside.names.empty()) return beside;
  return failure(ErrorCode::malformed,
                 fmt::format("'{}' has no column besides {}; there is nothing to read",
                             table.file().string(), fmt::join(keys, ", ")));
}

/// One row per month, in any order.
using RowsByMonth = std::map<DesignMonth, std::vector<double>>;

MonthlyTable make_table(const RowsByMonth& rows, std::vector<std::string> names) {
  MonthlyTable table;
  table.names = std::move(names);
  table.values.resize(static_cast<Eigen::Index>(rows.size()),
                      static_cast<Eigen::Index>(table.names.size()));
  for (const auto& [month, values] : rows) {
    const auto row = static_cast<Eigen::Index>(table.months.size());
    table.months.push_back(month);
    for (Eigen::Index j = 0; j < table.values.cols(); ++j) {
      table.values(row, j) = values[static_cast<std::size_t>(j)];
    }
  }
  return table;
}

/// Reads doe_inputs.csv: the runs and their places in the prior box.
class RunReader {
 public:
  RunReader(TableReader& table, DesignFolder& design) : table_{table}, design_{design} {}

  Result<void> read() {
    failed_ = TRY(read_failed_runs(table_.file().parent_path()));
    if (auto found = find_columns(); !found) return found;
    if (auto all = for_each_row(table_, [this] { return read_row(); }); !all) return all;
    note_open_end(table_, design_.notes);
    note_failed();
    if (design_.runs.size() < 2) {
      return failure(ErrorCode::not_enough_data,
                     fmt::format("'{}' has {} runs; a design needs at least 2, and a useful one "
                                 "some 10 a parameter",
                                 table_.file().string(), design_.runs.size()));
    }
    const auto q = static_cast<Eigen::Index>(design_.parameters.size());
    design_.theta = Eigen::Map<const RowMajor>(values_.data(),
                                               static_cast<Eigen::Index>(design_.runs.size()), q);
    return check_values();
  }

 private:
  using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

  Result<void> find_columns() {
    run_ = TRY(table_.require("run"));
    for (const Parameter& parameter : design_.parameters) {
      const auto column = TRY(table_.require(parameter.name));
      columns_.push_back(column);
    }
    for (const std::string& column : table_.columns()) {
      const bool known = std::ranges::find(design_.parameters, column, &Parameter::name) !=
                         design_.parameters.end();
      if (known || column == "run") continue;
      return failure(ErrorCode::malformed,
                     fmt::format("'{}': column '{}' is no parameter of the priors file; add its "
                                 "prior there or remove the column",
                                 table_.file().string(), column));
    }
    return {};
  }

  Result<void> read_row() {
    const auto run = TRY(table_.whole_number(run_));
    if (!seen_.insert(run).second) return table_.wrong(fmt::format("run {} comes twice", run));
    if (failed_.contains(run)) return {};
    design_.runs.push_back(run);
    for (const std::size_t column : columns_) {
      const auto value = TRY(table_.number(column));
      values_.push_back(value);
    }
    return {};
  }

  Result<void> check_values() {
    for (Eigen::Index j = 0; j < design_.theta.cols(); ++j) {
      const Parameter& parameter = design_.parameters[static_cast<std::size_t>(j)];
      const auto column = design_.theta.col(j);
      if (column.minCoeff() == column.maxCoeff()) {
        return failure(ErrorCode::invalid_value,
                       fmt::format("'{}': parameter '{}' is {} in every run, so nothing can be "
                                   "learnt of it; remove it from the design and from the priors",
                                   table_.file().string(), parameter.name, column[0]));
      }
      note_outside(parameter, column);
    }
    return {};
  }

  void note_failed() {
    if (failed_.empty()) return;
    const auto& [run, because] = *failed_.begin();
    design_.notes.push_back(fmt::format("{} of {} runs failed and are left out; run {}: {}",
                                        failed_.size(), seen_.size(), run, because));
  }

  void note_outside(const Parameter& parameter, const Eigen::Ref<const Eigen::VectorXd>& values) {
    const double min = parameter.prior.min();
    const double max = parameter.prior.max();
    const double slack = kRounding * (values.maxCoeff() - values.minCoeff());
    std::vector<int> outside;
    double worst = 0.0;
    for (Eigen::Index i = 0; i < values.size(); ++i) {
      if (values[i] >= min - slack && values[i] <= max + slack) continue;
      if (outside.empty()) worst = values[i];
      outside.push_back(design_.runs[static_cast<std::size_t>(i)]);
    }
    if (outside.empty()) return;
    design_.notes.push_back(fmt::format(
        "{}: {} of {} runs lie outside its prior, {} to {} (run {} has {}): the design was made "
        "for other priors.",
        parameter.name, outside.size(), design_.runs.size(), min, max, outside.front(), worst));
  }

  TableReader& table_;
  DesignFolder& design_;
  std::size_t run_ = 0;
  std::vector<std::size_t> columns_;
  std::vector<double> values_;
  std::set<int> seen_;
  std::map<int, std::string> failed_;
};

/// Reads doe_outputs.csv: every run in every month.
class OutputReader {
 public:
  OutputReader(TableReader& table, DesignFolder& design) : table_{table}, design_{design} {
    for (std::size_t i = 0; i < design.runs.size(); ++i) row_of_run_[design.runs[i]] = i;
  }

  Result<void> read() {
    constexpr std::string_view keys[] = {"run", "month"};
    columns_ = TRY(columns_beside(table_, keys));
    if (auto all = for_each_row(table_, [this] { return read_row(); }); !all) return all;
    note_open_end(table_, design_.notes);
    if (auto whole = check_runs(); !whole) return whole;
    if (auto whole = check_months(); !whole) return whole;
    fill();
    return {};
  }

 private:
  Result<void> read_row() {
    const auto run = TRY(table_.whole_number(*table_.find("run")));
    const auto known = row_of_run_.find(run);
    if (known == row_of_run_.end()) {
      return table_.wrong(fmt::format(
          "run {} is not in the file of run inputs; remove its rows or add it there", run));
    }
    const auto month = TRY(read_month(table_, *table_.find("month")));
    auto [place, is_new] = rows_[known->second].try_emplace(month);
    if (!is_new) {
      return table_.wrong(fmt::format("run {} has month {} twice", run, month.text()));
    }
    for (const std::size_t column : columns_.columns) {
      const auto value = TRY(table_.number(column));
      place->second.push_back(value);
    }
    months_.insert(month);
    return {};
  }

  Result<void> check_runs() const {
    std::vector<int> without;
    for (std::size_t i = 0; i < design_.runs.size(); ++i) {
      if (!rows_.contains(i)) without.push_back(design_.runs[i]);
    }
    if (without.empty()) return {};
    return failure(
        ErrorCode::malformed,
        fmt::format("'{}' lacks {} of {} runs ({}); run them, or remove them from the file of run "
                    "inputs",
                    table_.file().string(), without.size(), design_.runs.size(), texts(without)));
  }

  Result<void> check_months() const {
    if (months_.begin()->is_calendar() != months_.rbegin()->is_calendar()) {
      return failure(ErrorCode::malformed,
                     fmt::format("'{}' names some months by number and some as YYYY-MM; use one of "
                                 "the two",
                                 table_.file().string()));
    }
    if (months_.size() < 2) {
      return failure(ErrorCode::not_enough_data,
                     fmt::format("'{}' covers one month only; a design needs at least 2",
                                 table_.file().string()));
    }
    for (const auto& [row, by_month] : rows_) {
      std::vector<DesignMonth> absent;
      for (const DesignMonth month : months_) {
        if (!by_month.contains(month)) absent.push_back(month);
      }
      if (absent.empty()) continue;
      return failure(
          ErrorCode::malformed,
          fmt::format("'{}': run {} lacks {} of {} months ({}); every run needs all of them",
                      table_.file().string(), design_.runs[row], absent.size(), months_.size(),
                      texts(absent)));
    }
    return {};
  }

  void fill() {
    design_.output_names = columns_.names;
    design_.months.assign(months_.begin(), months_.end());
    const auto months = static_cast<Eigen::Index>(months_.size());
    const auto outputs = static_cast<Eigen::Index>(columns_.names.size());
    design_.outputs.resize(static_cast<Eigen::Index>(design_.runs.size()), outputs * months);
    for (const auto& [row, by_month] : rows_) {
      Eigen::Index i = 0;
      for (const auto& [month, values] : by_month) {
        for (Eigen::Index k = 0; k < outputs; ++k) {
          design_.outputs(static_cast<Eigen::Index>(row), k * months + i) =
              values[static_cast<std::size_t>(k)];
        }
        ++i;
      }
    }
  }

  TableReader& table_;
  DesignFolder& design_;
  ValueColumns columns_;
  std::map<int, std::size_t> row_of_run_;
  std::map<std::size_t, RowsByMonth> rows_;  ///< By row of theta.
  std::set<DesignMonth> months_;
};

/// Reads a file with one row per month. Blanks become NaN if they are allowed.
Result<MonthlyTable> read_months(TableReader& table, const ValueColumns& columns, bool blanks) {
  const auto month_column = TRY(table.require("month"));
  RowsByMonth rows;
  const auto read_row = [&]() -> Result<void> {
    const auto month = TRY(read_month(table, month_column));
    auto [place, is_new] = rows.try_emplace(month);
    if (!is_new) return table.wrong(fmt::format("month {} comes twice", month.text()));
    for (const std::size_t column : columns.columns) {
      const auto value = TRY(table.number_or_blank(column));
      if (!value && !blanks) return tl::unexpected(table.number(column).error());
      place->second.push_back(value.value_or(kAbsent));
    }
    return {};
  };
  TRY(for_each_row(table, read_row));
  return make_table(rows, columns.names);
}

Result<void> check_inputs(const fs::path& file, const DesignFolder& design) {
  std::vector<DesignMonth> absent;
  for (const DesignMonth month : design.months) {
    if (design.inputs.row_of(month) < 0) absent.push_back(month);
  }
  if (!absent.empty()) {
    return failure(ErrorCode::malformed,
                   fmt::format("'{}' lacks {} of {} months of the design ({}); its months have to "
                               "be written as those of the design and cover them",
                               file.string(), absent.size(), design.months.size(), texts(absent)));
  }
  const Eigen::MatrixXd covered = design.design_inputs();
  for (Eigen::Index j = 0; j < covered.cols(); ++j) {
    if (covered.col(j).minCoeff() < covered.col(j).maxCoeff()) continue;
    return failure(ErrorCode::invalid_value,
                   fmt::format("'{}': model input '{}' is {} in every month of the design, so it "
                               "explains nothing; remove the column",
                               file.string(), design.inputs.names[static_cast<std::size_t>(j)],
                               covered(0, j)));
  }
  return {};
}

/// A meta-model names its terms after inputs and parameters, so every name must be unique.
Result<void> check_names(const DesignFolder& design) {
  std::set<std::string> names;
  for (const Parameter& parameter : design.parameters) names.insert(parameter.name);
  const auto take = [&](const std::string& name) { return names.insert(name).second; };
  for (const auto& list : {design.inputs.names, design.output_names}) {
    const auto twice = std::ranges::find_if_not(list, take);
    if (twice == list.end()) continue;
    return failure(
        ErrorCode::invalid_value,
        fmt::format("'{}': '{}' is the name of two things among parameters, model inputs "
                    "and outputs; rename one of them in its files",
                    design.folder.string(), *twice));
  }
  return {};
}

struct Files {
  fs::path priors;
  fs::path inputs;
  fs::path outputs;
};

Files files_of(const fs::path& folder, const std::string& design) {
  if (design.empty()) {
    return {folder / "priors.csv", folder / "doe_inputs.csv", folder / "doe_outputs.csv"};
  }
  return {folder / (design + "_priors.csv"), folder / (design + "_inputs.csv"),
          folder / (design + "_outputs.csv")};
}

template <class Reader>
Result<void> read_with(const fs::path& file, DesignFolder& design) {
  auto table = TRY(TableReader::open(file));
  return Reader{table, design}.read();
}

Result<void> read_inputs(const fs::path& file, DesignFolder& design) {
  auto table = TRY(TableReader::open(file));
  constexpr std::string_view keys[] = {"month"};
  const auto columns = TRY(columns_beside(table, keys));
  auto inputs = TRY(read_months(table, columns, /*blanks=*/false));
  note_open_end(table, design.notes);
  design.inputs = std::move(inputs);
  return check_inputs(file, design);
}

/// Finds the columns of the measured outputs, in the design's order; notes those that are absent.
ValueColumns measured_columns(const TableReader& table, const DesignFolder& design,
                              std::vector<std::string>& notes) {
  ValueColumns columns;
  std::vector<std::string> absent;
  for (const std::string& output : design.output_names) {
    if (const auto column = table.find(output)) {
      columns.columns.push_back(*column);
      columns.names.push_back(output);
    } else {
      absent.push_back(output);
    }
  }
  if (!absent.empty()) {
    notes.push_back(fmt::format("{} {} not measured in '{}' and left out.", listed(absent),
                                absent.size() == 1 ? "is" : "are", table.file().string()));
  }
  return columns;
}

/// Puts the measured columns in their places among all outputs; the others are NaN.
Eigen::MatrixXd among_all(const MonthlyTable& measured, const std::vector<std::string>& outputs) {
  Eigen::MatrixXd all = Eigen::MatrixXd::Constant(
      measured.values.rows(), static_cast<Eigen::Index>(outputs.size()), kAbsent);
  for (std::size_t j = 0; j < measured.names.size(); ++j) {
    const auto place = std::ranges::find(outputs, measured.names[j]) - outputs.begin();
    all.col(place) = measured.values.col(static_cast<Eigen::Index>(j));
  }
  return all;
}

/// Drops the months that have no model inputs.
MonthlyTable with_inputs(MonthlyTable measured, const MonthlyTable& inputs,
                         std::vector<std::string>& notes) {
  std::vector<DesignMonth> unknown;
  std::vector<Eigen::Index> kept;
  for (std::size_t i = 0; i < measured.months.size(); ++i) {
    if (inputs.row_of(measured.months[i]) < 0) {
      unknown.push_back(measured.months[i]);
    } else {
      kept.push_back(static_cast<Eigen::Index>(i));
    }
  }
  if (unknown.empty()) return measured;
  notes.push_back(
      fmt::format("Measured months without a row in inputs.csv are left out: {}.", texts(unknown)));
  std::vector<DesignMonth> months;
  months.reserve(kept.size());
  for (const Eigen::Index row : kept) {
    months.push_back(measured.months[static_cast<std::size_t>(row)]);
  }
  measured.values = measured.values(kept, Eigen::all).eval();
  measured.months = std::move(months);
  return measured;
}

bool measures_any(const MonthlyTable& measured, const std::vector<DesignMonth>& months) {
  return std::ranges::any_of(months, [&](DesignMonth month) {
    const Eigen::Index row = measured.row_of(month);
    return row >= 0 && !measured.values.row(row).array().isNaN().all();
  });
}

}  // namespace

Eigen::Index MonthlyTable::row_of(DesignMonth month) const {
  const auto found = std::ranges::lower_bound(months, month);
  return found == months.end() || *found != month ? -1 : found - months.begin();
}

Eigen::MatrixXd DesignFolder::design_inputs() const {
  Eigen::MatrixXd covered(static_cast<Eigen::Index>(months.size()), inputs.values.cols());
  for (std::size_t i = 0; i < months.size(); ++i) {
    covered.row(static_cast<Eigen::Index>(i)) = inputs.values.row(inputs.row_of(months[i]));
  }
  return covered;
}

Result<DesignFolder> read_design_folder(const fs::path& folder, const std::string& design_name) {
  std::error_code ignored;
  if (!fs::is_directory(folder, ignored)) {
    return failure(ErrorCode::not_found,
                   fmt::format("the design folder '{}' does not exist", folder.string()));
  }
  const Files files = files_of(folder, design_name);
  DesignFolder design;
  design.folder = folder;
  design.files = {files.priors, files.inputs, files.outputs, folder / "inputs.csv"};
  design.parameters = TRY(read_priors(files.priors));
  TRY(read_with<RunReader>(files.inputs, design));
  TRY(read_with<OutputReader>(files.outputs, design));
  TRY(read_inputs(folder / "inputs.csv", design));
  TRY(check_names(design));
  return design;
}

Result<Measurements> read_measurements(const fs::path& file, const DesignFolder& design) {
  auto table = TRY(TableReader::open(file));
  Measurements result;
  const ValueColumns columns = measured_columns(table, design, result.notes);
  if (columns.names.empty()) {
    return failure(
        ErrorCode::not_enough_data,
        fmt::format("'{}' measures no output of the design ({}); its columns are {}", file.string(),
                    listed(design.output_names), listed(table.columns())));
  }
  auto measured = TRY(read_months(table, columns, /*blanks=*/true));
  note_open_end(table, result.notes);
  measured.values = among_all(measured, design.output_names);
  measured.names = design.output_names;
  if (!measures_any(measured, design.months)) {
    return failure(
        ErrorCode::not_enough_data,
        fmt::format("'{}' measures no month of the design, {} to {}, so nothing can be "
                    "calibrated",
                    file.string(), design.months.front().text(), design.months.back().text()));
  }
  result.table = with_inputs(std::move(measured), design.inputs, result.notes);
  return result;
}

}  // namespace recald::doe
