#include "adapters/doe/design_writer.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <optional>
#include <sstream>

#include "adapters/doe/failed_runs_file.hpp"
#include "adapters/doe/priors_file.hpp"
#include "adapters/doe/table_reader.hpp"
#include "adapters/system/files/write_file.hpp"
#include "core/absent.hpp"

namespace recald::doe {
namespace {

namespace fs = std::filesystem;

constexpr const char* kStateFile = "design.json";

/// The shortest text that reads back as the same bits; blank for a value that is not finite.
std::string field(double value) { return std::isfinite(value) ? fmt::format("{}", value) : ""; }

std::string runs_csv(const DesignPlan& plan) {
  std::string text = "run";
  for (const Parameter& parameter : plan.parameters) text += "," + parameter.name;
  text += '\n';
  for (Eigen::Index i = 0; i < plan.theta.rows(); ++i) {
    text += std::to_string(i + 1);
    for (const double value : plan.theta.row(i)) text += "," + field(value);
    text += '\n';
  }
  return text;
}

std::string monthly_csv(const MonthlyTable& table) {
  std::string text = fmt::format("month,{}\n", fmt::join(table.names, ","));
  for (std::size_t i = 0; i < table.months.size(); ++i) {
    text += table.months[i].text();
    for (const double value : table.values.row(static_cast<Eigen::Index>(i))) {
      text += "," + field(value);
    }
    text += '\n';
  }
  return text;
}

std::string outputs_csv(const DesignPlan& plan, const DesignRunsSoFar& runs) {
  std::string text = fmt::format("run,month,{}\n", fmt::join(plan.output_names, ","));
  const auto months = static_cast<Eigen::Index>(plan.months.size());
  for (std::size_t r = 0; r < runs.done.size(); ++r) {
    if (!runs.done[r]) continue;
    for (Eigen::Index i = 0; i < months; ++i) {
      text += fmt::format("{},{}", r + 1, plan.months[static_cast<std::size_t>(i)].text());
      for (std::size_t k = 0; k < plan.output_names.size(); ++k) {
        text += "," + field(runs.outputs(static_cast<Eigen::Index>(r),
                                         static_cast<Eigen::Index>(k) * months + i));
      }
      text += '\n';
    }
  }
  return text;
}

std::string state_json(const DesignPlan& plan, Eigen::Index runs) {
  const nlohmann::ordered_json state = {{"made_by", "recald doe"},
                                        {"runs", runs},
                                        {"seed", plan.seed},
                                        {"fingerprint", plan.fingerprint}};
  return state.dump(2) + "\n";
}

/// Errors are ignored here; reading the file will report them.
bool is_there(const fs::path& file) {
  std::error_code ignored;
  return fs::exists(file, ignored);
}

std::optional<std::string> text_of(const fs::path& file) {
  std::ifstream in{file, std::ios::binary};
  if (!in) return {};
  std::ostringstream text;
  text << in.rdbuf();
  return text.str();
}

/// Why the folder's design differs from the plan; empty if it does not, or if the folder has no
/// design yet.
std::string difference(const fs::path& folder, const DesignPlan& plan) {
  const auto state = text_of(folder / kStateFile);
  if (!state) {
    const bool used = is_there(folder / "priors.csv") || is_there(folder / "doe_outputs.csv");
    return used ? "was not made by recald doe" : "";
  }
  const auto priors = text_of(folder / "priors.csv");
  if (priors && *priors != priors_csv(plan.parameters)) return "was made for other priors";
  const auto runs = text_of(folder / "doe_inputs.csv");
  if (runs && !runs_csv(plan).starts_with(*runs)) {
    return "has other runs: by another seed or number, by --priors or --corners, or by another "
           "version";
  }
  const auto parsed = nlohmann::json::parse(*state, nullptr, /*allow_exceptions=*/false);
  const Eigen::Index before =
      parsed.is_object() ? parsed.value("runs", plan.theta.rows()) : plan.theta.rows();
  if (*state == state_json(plan, before)) return "";
  return "was made from another site file, other readings or weather, or by another version";
}

Result<void> write_plan(const fs::path& folder, const DesignPlan& plan) {
  if (auto made = system::make_folder(folder); !made) return made;
  const auto write = [&](const char* name, const std::string& text) {
    return system::write_file(folder / name, text);
  };
  // Written first, so that any other file in the folder can be traced to its plan.
  if (auto w = write(kStateFile, state_json(plan, plan.theta.rows())); !w) return w;
  if (auto w = write("priors.csv", priors_csv(plan.parameters)); !w) return w;
  if (auto w = write("doe_inputs.csv", runs_csv(plan)); !w) return w;
  if (auto w = write("inputs.csv", monthly_csv(plan.inputs)); !w) return w;
  return write("measurements.csv", monthly_csv(plan.measurements));
}

/// Reads the runs of doe_outputs.csv into `runs`.
Result<void> read_runs(const fs::path& file, const DesignPlan& plan, DesignRunsSoFar& runs) {
  auto table = TRY(TableReader::open(file));
  std::vector<std::string> columns{"run", "month"};
  columns.insert(columns.end(), plan.output_names.begin(), plan.output_names.end());
  if (table.columns() != columns) return table.wrong("the columns are not those of this design");
  const auto months = static_cast<Eigen::Index>(plan.months.size());
  for (Eigen::Index row = 0;; ++row) {
    const auto more = TRY(table.next());
    if (!more) break;
    const auto run = TRY(table.whole_number(0));
    const Eigen::Index i = row % months;
    if (run < 1 || run > runs.outputs.rows() ||
        table.text(1) != plan.months[static_cast<std::size_t>(i)].text()) {
      return table.wrong("this is no run of this design; delete the file to run all of them again");
    }
    for (std::size_t k = 0; k < plan.output_names.size(); ++k) {
      const auto value = TRY(table.number(k + 2));
      runs.outputs(run - 1, static_cast<Eigen::Index>(k) * months + i) = value;
    }
  }
  // A truncated file may end within a run; that run is not done.
  for (std::size_t r = 0; r < runs.done.size(); ++r) {
    runs.done[r] = runs.outputs.row(static_cast<Eigen::Index>(r)).allFinite();
  }
  return {};
}

}  // namespace

int DesignRunsSoFar::done_count() const { return static_cast<int>(std::ranges::count(done, true)); }

Result<DesignRunsSoFar> open_design(const fs::path& folder, const DesignPlan& plan) {
  if (const std::string why = difference(folder, plan); !why.empty()) {
    return failure(ErrorCode::invalid_value,
                   fmt::format("'{}' holds a design that {}; delete it, or give another --out",
                               folder.string(), why));
  }
  TRY(write_plan(folder, plan));
  const auto runs = static_cast<std::size_t>(plan.theta.rows());
  const auto values = static_cast<Eigen::Index>(plan.output_names.size() * plan.months.size());
  DesignRunsSoFar so_far{Eigen::MatrixXd::Constant(plan.theta.rows(), values, kAbsent),
                         std::vector<bool>(runs, false)};
  const fs::path outputs = folder / "doe_outputs.csv";
  if (!is_there(outputs)) return so_far;
  TRY(read_runs(outputs, plan, so_far));
  return so_far;
}

std::string fingerprint_of(const fs::path& folder) {
  const auto text = text_of(folder / kStateFile);
  const auto state = nlohmann::json::parse(text.value_or(""), nullptr, /*allow_exceptions=*/false);
  return state.is_object() ? state.value("fingerprint", "") : "";
}

Result<void> write_outputs(const fs::path& folder, const DesignPlan& plan,
                           const DesignRunsSoFar& runs) {
  if (auto written = write_failed_runs(folder, runs.failed); !written) return written;
  return system::write_file(folder / "doe_outputs.csv", outputs_csv(plan, runs));
}

}  // namespace recald::doe
