/// What all pages share: the head that blocks the network, a masthead, links, parts, and at the end
/// the figures' data and the script that draws them.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "adapters/views/frame/report_data.hpp"

namespace recald::views {

struct PageHead {
  std::string title;
  SiteLine site;
  std::string generated_at;  ///< As shown to readers; empty: left out.
};

/// One part of a page; if it has no markup, it and its link are left out.
struct PagePart {
  std::string_view id;
  std::string_view link_text;
  std::string markup;
};

/// @param figure_json  Safe inside a script tag; see `script_safe_text`.
[[nodiscard]] std::string render_page(const PageHead& head, const std::vector<PagePart>& parts,
                                      const std::string& figure_json);

}  // namespace recald::views
