/// What every page has: the head that forbids the network, a masthead, links, parts, and at the end
/// the figures' data and the script that draws them.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "adapters/report/report_data.hpp"

namespace recald::report {

struct PageHead {
  std::string title;
  SiteLine site;
  std::string generated_at;  ///< As it shall be read; empty: left out.
};

/// One part of a page; without markup it is left out, and so is the link to it.
struct PagePart {
  std::string_view id;
  std::string_view link_text;
  std::string markup;
};

/// @param figure_json  Safe inside a script tag, as `script_safe_text` makes it.
[[nodiscard]] std::string render_page(const PageHead& head, const std::vector<PagePart>& parts,
                                      const std::string& figure_json);

}  // namespace recald::report
