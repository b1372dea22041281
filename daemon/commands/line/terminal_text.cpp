#include "daemon/commands/line/terminal_text.hpp"

#include <algorithm>
#include <string>
#include <string_view>

#include "core/text/printable.hpp"
#include "daemon/commands/console.hpp"

namespace recald::daemon {

std::streamsize TerminalText::xsputn(const char* text, std::streamsize count) {
  std::string_view rest{text, static_cast<std::size_t>(count)};
  std::string shown;
  while (!rest.empty()) {
    const std::size_t drawn = std::min(rest.find(kLineOver), rest.size());
    shown += printable(rest.substr(0, drawn), "\n\t");
    rest.remove_prefix(drawn);
    if (rest.empty()) break;
    shown += kLineOver;
    rest.remove_prefix(kLineOver.size());
  }
  const auto size = static_cast<std::streamsize>(shown.size());
  return to_.sputn(shown.data(), size) == size ? count : 0;
}

TerminalText::int_type TerminalText::overflow(int_type character) {
  if (traits_type::eq_int_type(character, traits_type::eof())) return traits_type::not_eof(0);
  const char one = traits_type::to_char_type(character);
  return xsputn(&one, 1) == 1 ? character : traits_type::eof();
}

}  // namespace recald::daemon
