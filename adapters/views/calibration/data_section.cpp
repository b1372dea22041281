#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "adapters/views/frame/format.hpp"
#include "adapters/views/frame/sections.hpp"

namespace recald::views {
namespace {

Cell coverage_cell(const OutputMonth& month) {
  // Rounded down: 99.9 % measured is not 100 %.
  const int percent = static_cast<int>(month.figure.coverage * 100.0);
  if (!month.figure.usable) return {fmt::format("✕\u00a0{}\u00a0%", percent), "bad"};
  return {fmt::format("{}\u00a0%", percent), month.figure.filled_share > 0.0 ? "partly" : "whole"};
}

/// Years as rows, January to December as columns: three years fit one screen.
void write_coverage_overview(Html& html, const std::vector<OutputResult>& outputs) {
  Table table("Share of each month that was measured. ✕: too little to use.");
  std::vector<std::string> columns{"Year"};
  for (unsigned month = 1; month <= 12; ++month) columns.push_back(month_name(month));
  table.columns(columns);
  for (const OutputResult& output : outputs) {
    std::map<int, std::vector<Cell>> years;
    for (const OutputMonth& month : output.months) {
      auto& cells =
          years.try_emplace(int{month.figure.month.year()}, 13, Cell{"·", "muted"}).first->second;
      cells[unsigned{month.figure.month.month()}] = coverage_cell(month);
    }
    table.group(output.label);
    for (auto& [year, cells] : years) {
      cells[0] = {std::to_string(year)};
      table.row(cells);
    }
  }
  html.markup("<div class=\"coverage\">");
  table.write(html);
  html.markup("</div>\n");
}

/// "104 of 108 meter months are usable. Not usable: Steam Mar 2021 (…)."
void write_coverage_words(Html& html, const std::vector<OutputResult>& outputs) {
  std::size_t usable = 0;
  std::size_t total = 0;
  std::size_t named = 0;
  std::string unusable;
  for (const OutputResult& output : outputs) {
    for (const OutputMonth& month : output.months) {
      ++total;
      if (month.figure.usable) {
        ++usable;
      } else if (++named <= 6) {
        unusable += fmt::format(
            "{}{}, {} ({})", named == 1 ? "" : "; ", output.label, month_text(month.figure.month),
            month.figure.unusable_because.empty() ? "no reason given"
                                                  : month.figure.unusable_because);
      }
    }
  }
  std::string sentence = fmt::format("{} of {} meter months are usable.", usable, total);
  if (named > 0) sentence += fmt::format(" Not used: {}", unusable);
  if (named > 6) sentence += fmt::format("; and {} more, in the table below", named - 6);
  html.element("p", named > 0 ? sentence + "." : sentence);
}

void write_coverage_details(Html& html, const std::vector<OutputResult>& outputs) {
  Table table("Coverage by meter and month");
  table.columns({"Month", "Measured", "Estimated", "Used", "Why not"});
  for (const OutputResult& output : outputs) {
    table.group(output.label);
    for (const OutputMonth& month : output.months) {
      table.row({{month_text(month.figure.month)},
                 {percent_text(month.figure.coverage, 2), "number"},
                 {percent_text(month.figure.filled_share, 2), "number"},
                 {month.figure.usable ? "yes" : "✕ no", month.figure.usable ? "" : "bad"},
                 {month.figure.unusable_because}});
    }
  }
  html.markup("<details class=\"data\"><summary>Coverage month by month, with reasons</summary>\n");
  table.write(html);
  html.markup("</details>\n");
}

void write_findings(Html& html, const ReportData& data) {
  html.element("h3", "What the readings showed");
  if (data.findings.empty()) {
    html.element("p", "Nothing that the checks look for was found in the readings.");
    return;
  }
  Table table("Findings in the readings; local time");
  table.columns({"Meter", "From", "To", "Intervals", "Finding"});
  for (const metering::DataFinding& finding : data.findings) {
    const auto [begin, end] = finding.span;
    const bool dated = end > begin;
    table.row({{finding.meter},
               {dated ? local_text(begin, data.calendar) : "", "nowrap"},
               {dated ? local_text(end, data.calendar) : "", "nowrap"},
               {count_text(finding.slots), "number"},
               {finding.sentence, "words"}});
  }
  table.write(html);
}

}  // namespace

void write_data_section(Html& html, const ReportData& data) {
  const bool is_covered = std::ranges::any_of(data.outputs, has_known_coverage);
  if (!is_covered && data.findings.empty()) return;
  open_section(html, "data", "Are the data good?");
  if (is_covered) {
    write_coverage_words(html, data.outputs);
    write_coverage_overview(html, data.outputs);
    write_coverage_details(html, data.outputs);
  }
  write_findings(html, data);
  html.markup("</section>\n");
}

}  // namespace recald::views
