#include "tests/support/sample_exports.hpp"

#include <array>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <stdexcept>

#include "tests/support/zip_file.hpp"

namespace recald::testing {
namespace {

using metering::Instant;

/// 0…1, the same for the same place.
double noise(unsigned seed, std::uint64_t place) {
  std::uint64_t x = place * 0x9E3779B97F4A7C15u + seed * 0xD1B54A32D192ED03u + 1;
  x = (x ^ (x >> 30)) * 0xBF58476D1CE4E5B9u;
  x = (x ^ (x >> 27)) * 0x94D049BB133111EBu;
  return static_cast<double>((x ^ (x >> 31)) >> 11) / 9007199254740992.0;
}

std::string formatted(const char* format, double value) {
  std::array<char, 64> text{};
  std::snprintf(text.data(), text.size(), format, value);
  return text.data();
}

std::string cell_name(std::size_t column, std::size_t row) {
  return std::string(1, static_cast<char>('A' + column)) + std::to_string(row);
}

std::string sheet_of(const std::vector<std::string>& header, const std::vector<WorkbookRow>& rows) {
  std::string xml =
      "<?xml version=\"1.0\" encoding=\"UTF-8\"?><worksheet xmlns=\"http://schemas.openxmlformats."
      "org/spreadsheetml/2006/main\"><sheetData><row r=\"1\">";
  for (std::size_t i = 0; i < header.size(); ++i) {
    xml += "<c r=\"" + cell_name(i, 1) + "\" t=\"s\"><v>" + std::to_string(i) + "</v></c>";
  }
  xml += "</row>";
  for (std::size_t k = 0; k < rows.size(); ++k) {
    const std::size_t number = k + 2;
    xml += "<row r=\"" + std::to_string(number) + "\"><c r=\"" + cell_name(0, number) +
           "\" s=\"1\"><v>" + formatted("%.10f", rows[k].day) + "</v></c>";
    for (std::size_t i = 0; i < rows[k].values.size(); ++i) {
      xml += "<c r=\"" + cell_name(i + 1, number) + "\"><v>" +
             formatted("%.15g", rows[k].values[i]) + "</v></c>";
    }
    xml += "</row>";
  }
  return xml + "</sheetData></worksheet>";
}

}  // namespace

ExportTruth made_up_use(const metering::LocalCalendar& calendar, const ExportSpan& span,
                        unsigned seed, double mean) {
  ExportTruth truth;
  const Instant end = calendar.day_span(span.last).end;
  std::uint64_t place = 0;
  for (Instant t = calendar.day_span(span.first).begin; t < end; t += span.step, ++place) {
    const metering::LocalTime local = calendar.local_time(t);
    const std::chrono::weekday weekday{std::chrono::sys_days{local.date}};
    const bool is_work = weekday != std::chrono::Saturday && weekday != std::chrono::Sunday &&
                         local.minute_of_day >= 420 && local.minute_of_day < 1140;
    const double wave = std::sin(static_cast<double>(place) / 700.0 + seed);
    const double raw = mean * ((is_work ? 1.4 : 0.6) + 0.2 * wave + 0.4 * noise(seed, place));
    const double written = std::round(raw * 1000.0) / 1000.0;
    truth.intervals.push_back({t, written});
    truth.month_sums[metering::to_string(calendar.month_of(t))] += written;
  }
  return truth;
}

std::string clock_text(const metering::LocalCalendar& calendar, Instant t,
                       const std::string& pattern) {
  const std::time_t shown = (t + calendar.utc_offset(t)).time_since_epoch().count();
  std::tm parts{};
  gmtime_r(&shown, &parts);
  std::array<char, 64> text{};
  const std::size_t length = std::strftime(text.data(), text.size(), pattern.c_str(), &parts);
  return {text.data(), length};
}

std::string with_point(double value) { return formatted("%.3f", value); }

std::string with_comma(double value) {
  std::string text = with_point(value);
  text[text.find('.')] = ',';
  return text;
}

double spreadsheet_day(const metering::LocalCalendar& calendar, Instant t) {
  const auto shown = (t + calendar.utc_offset(t)).time_since_epoch();
  return 25'569.0 + static_cast<double>(shown.count()) / 86'400.0;
}

void write_workbook(const std::filesystem::path& file, const std::vector<std::string>& header,
                    const std::vector<WorkbookRow>& rows) {
  const std::string ns = "xmlns=\"http://schemas.openxmlformats.org/spreadsheetml/2006/main\"";
  const std::string book =
      "<workbook " + ns +
      " xmlns:r=\"http://schemas.openxmlformats.org/officeDocument/2006/relationships\"><sheets>"
      "<sheet name=\"Meters\" sheetId=\"1\" r:id=\"rId1\"/></sheets></workbook>";
  const std::string relations =
      "<Relationships xmlns=\"http://schemas.openxmlformats.org/package/2006/relationships\">"
      "<Relationship Id=\"rId1\" Type=\"worksheet\" Target=\"worksheets/sheet1.xml\"/>"
      "</Relationships>";
  const std::string styles =
      "<styleSheet " + ns +
      "><numFmts><numFmt numFmtId=\"164\" formatCode=\"yyyy\\-mm\\-dd\\ hh:mm:ss.000\"/></numFmts>"
      "<cellXfs><xf numFmtId=\"0\"/><xf numFmtId=\"164\"/></cellXfs></styleSheet>";
  std::string shared = "<sst " + ns + ">";
  for (const std::string& text : header) shared += "<si><t>" + text + "</t></si>";
  shared += "</sst>";
  const std::string sheet = sheet_of(header, rows);
  write_zip(file, {{"xl/workbook.xml", book},
                   {"xl/_rels/workbook.xml.rels", relations},
                   {"xl/styles.xml", styles},
                   {"xl/sharedStrings.xml", shared},
                   {"xl/worksheets/sheet1.xml", sheet}});
}

}  // namespace recald::testing
