/// What tests look for in a page.
#pragma once

#include <string>
#include <string_view>

#include "adapters/views/frame/assets.hpp"

namespace recald::views {

/// The page without its embedded script, style and licence texts: what is made from the data.
inline std::string own_markup(std::string page) {
  for (const std::string_view asset : {assets().script, assets().style}) {
    const std::size_t at = page.find(asset);
    if (at != std::string::npos) page.erase(at, asset.size());
  }
  const std::size_t licences = page.find("<details id=\"licences\">");
  if (licences != std::string::npos) {
    page.erase(licences, page.find("</details>", licences) - licences);
  }
  return page;
}

inline std::size_t occurrences(std::string_view text, std::string_view what) {
  std::size_t count = 0;
  for (std::size_t at = text.find(what); at != std::string_view::npos;
       at = text.find(what, at + 1)) {
    ++count;
  }
  return count;
}

}  // namespace recald::views
