#include "adapters/views/frame/most_likely.hpp"

#include "adapters/views/frame/html.hpp"

namespace recald::views {

std::string most_likely_markup(std::string_view sentence) {
  if (sentence.empty()) {
    return "What is missing is not known yet: <code>recald diagnose</code> looks for it.";
  }
  return escape(sentence) + " <a href=\"diagnosis.html\">How sure that is, and why</a>";
}

std::optional<std::string> with_most_likely(std::string page, std::string_view data_revision,
                                            std::string_view sentence) {
  const std::size_t open = page.find(kMostLikelyOpen);
  if (open == std::string::npos || data_revision.empty() ||
      page.find(data_revision) == std::string::npos) {
    return std::nullopt;
  }
  const std::size_t begin = open + kMostLikelyOpen.size();
  const std::size_t end = page.find("</p>", begin);
  if (end == std::string::npos) return std::nullopt;
  page.replace(begin, end - begin, most_likely_markup(sentence));
  return page;
}

}  // namespace recald::views
