#include "adapters/energyplus/run/error_file.hpp"

#include <fstream>
#include <iterator>
#include <optional>

#include "core/text/printable.hpp"

namespace recald::energyplus {
namespace {

constexpr std::size_t kSevereKept = 20;
constexpr std::size_t kSentenceMax = 600;

std::string_view trimmed(std::string_view text) {
  const std::size_t begin = text.find_first_not_of(" \t\r");
  if (begin == std::string_view::npos) return {};
  return text.substr(begin, text.find_last_not_of(" \t\r") - begin + 1);
}

/// What stands behind a mark such as "** Severe  **", or none.
std::optional<std::string_view> behind(std::string_view line, std::string_view mark) {
  const std::size_t at = line.find(mark);
  if (at == std::string_view::npos || at > 8) return {};
  return trimmed(line.substr(at + mark.size()));
}

}  // namespace

std::string ErrorFile::words() const {
  if (!severe.empty()) return severe.front();
  return fatal.empty() ? "" : fatal.front();
}

ErrorFile parse_error_file(std::string_view text) {
  ErrorFile file;
  std::string* open = nullptr;  // the message that may go on
  const auto begin = [&](std::vector<std::string>& list, std::string_view message) {
    open = nullptr;
    if (list.size() == kSevereKept) return;
    list.push_back(printable(message));
    open = &list.back();
  };
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    const std::string_view line = text.substr(0, end);
    text.remove_prefix(std::min(end + 1, text.size()));
    if (const auto fatal = behind(line, "**  Fatal  **")) {
      begin(file.fatal, *fatal);
    } else if (const auto severe = behind(line, "** Severe  **")) {
      ++file.severe_count;
      begin(file.severe, *severe);
    } else if (behind(line, "** Warning **")) {
      ++file.warning_count;
      open = nullptr;
    } else if (const auto more = behind(line, "**   ~~~   **")) {
      if (open == nullptr || open->size() > kSentenceMax) continue;
      *open += (more->starts_with("..") || more->empty() ? "" : " ") + printable(*more);
    } else {
      open = nullptr;
      file.is_complete = file.is_complete ||
                         line.find("EnergyPlus Completed Successfully") != std::string_view::npos ||
                         line.find("EnergyPlus Terminated") != std::string_view::npos;
    }
  }
  return file;
}

ErrorFile read_error_file(const std::filesystem::path& file) {
  std::ifstream in{file, std::ios::binary};
  const std::string text{std::istreambuf_iterator<char>{in}, {}};
  return parse_error_file(text);
}

}  // namespace recald::energyplus
