#include "adapters/doe/days_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <map>
#include <utility>

#include "adapters/doe/table_reader.hpp"
#include "adapters/system/files/write_file.hpp"
#include "core/absent.hpp"

namespace recald::doe {
namespace {

using metering::Day;

/// Reads doe_days.csv row by row, in any order.
class DayReader {
 public:
  DayReader(TableReader& table, const DesignFolder& design) : table_{table}, design_{design} {
    for (std::size_t i = 0; i < design.runs.size(); ++i) {
      row_of_run_[design.runs[i]] = static_cast<Eigen::Index>(i);
    }
    values_of_run_.resize(design.runs.size());
  }

  Result<DesignDays> read() {
    TRY(find_columns());
    for (;;) {
      const auto more = TRY(table_.next());
      if (!more) break;
      TRY(read_row());
    }
    if (table_.ends_open()) {
      return table_.wrong("the file ends within a line; delete it and run `recald doe` again");
    }
    return collected();
  }

 private:
  Result<void> find_columns() {
    for (const auto& [name, column] : {std::pair{"run", &run_}, std::pair{"day", &day_}}) {
      *column = TRY(table_.require(name));
    }
    for (const std::string& output : design_.output_names) {
      const auto found = TRY(table_.require(output));
      columns_.push_back(found);
    }
    return {};
  }

  Result<void> read_row() {
    const auto run = TRY(table_.whole_number(run_));
    const auto known = row_of_run_.find(run);
    if (known == row_of_run_.end()) return {};
    const auto day = metering::parse_day(table_.text(day_));
    if (!day) return table_.wrong(day.error().message);
    auto& of_run = values_of_run_[static_cast<std::size_t>(known->second)];
    auto [place, is_new] = of_run.try_emplace(*day);
    if (!is_new) {
      return table_.wrong(fmt::format("run {} has {} twice", run, metering::to_string(*day)));
    }
    place->second.reserve(columns_.size());
    for (const std::size_t column : columns_) {
      const auto value = TRY(table_.number(column));
      place->second.push_back(value);
    }
    return {};
  }

  [[nodiscard]] Result<DesignDays> collected() const {
    DesignDays days;
    for (const auto& [day, values] : values_of_run_.front()) days.days.push_back(day);
    const auto n = static_cast<Eigen::Index>(days.days.size());
    const auto outputs = static_cast<Eigen::Index>(columns_.size());
    days.values.resize(static_cast<Eigen::Index>(design_.runs.size()), outputs * n);
    for (std::size_t r = 0; r < values_of_run_.size(); ++r) {
      const auto& of_run = values_of_run_[r];
      const bool is_same =
          !of_run.empty() &&
          std::ranges::equal(of_run, days.days, {}, [](const auto& d) { return d.first; });
      if (!is_same) {
        return failure(
            ErrorCode::malformed,
            fmt::format("'{}': run {} has {} days, not the {} of run {}; every run of the "
                        "design needs the same days, so delete the file and run "
                        "`recald doe` again",
                        table_.file().string(), design_.runs[r], of_run.size(), days.days.size(),
                        design_.runs.front()));
      }
      Eigen::Index i = 0;
      for (const auto& [day, values] : of_run) {
        for (Eigen::Index k = 0; k < outputs; ++k) {
          days.values(static_cast<Eigen::Index>(r), k * n + i) =
              values[static_cast<std::size_t>(k)];
        }
        ++i;
      }
    }
    return days;
  }

  TableReader& table_;
  const DesignFolder& design_;
  std::size_t run_ = 0;
  std::size_t day_ = 0;
  std::vector<std::size_t> columns_;
  std::map<int, Eigen::Index> row_of_run_;
  std::vector<std::map<Day, std::vector<double>>> values_of_run_;  ///< By row of theta.
};

}  // namespace

std::filesystem::path days_file(const std::filesystem::path& folder) {
  return folder / "doe_days.csv";
}

Result<DesignDays> read_design_days(const DesignFolder& design) {
  auto table = TRY(TableReader::open(days_file(design.folder)));
  return DayReader{table, design}.read();
}

Result<void> write_design_days(const std::filesystem::path& folder, const std::vector<int>& runs,
                               const std::vector<std::string>& output_names,
                               const DesignDays& days) {
  fmt::memory_buffer text;
  const auto out = std::back_inserter(text);
  fmt::format_to(out, "run,day,{}\n", fmt::join(output_names, ","));
  std::vector<std::string> names;
  for (const Day day : days.days) names.push_back(metering::to_string(day));
  const auto n = static_cast<Eigen::Index>(days.days.size());
  const auto outputs = static_cast<Eigen::Index>(output_names.size());
  for (std::size_t r = 0; r < runs.size(); ++r) {
    for (Eigen::Index i = 0; i < n; ++i) {
      fmt::format_to(out, "{},{}", runs[r], names[static_cast<std::size_t>(i)]);
      for (Eigen::Index k = 0; k < outputs; ++k) {
        fmt::format_to(out, ",{:.5g}", days.values(static_cast<Eigen::Index>(r), k * n + i));
      }
      fmt::format_to(out, "\n");
    }
  }
  return system::write_file(days_file(folder), fmt::to_string(text));
}

}  // namespace recald::doe
