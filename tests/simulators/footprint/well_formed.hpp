/// What a test can say of a picture without looking at it.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <string_view>
#include <vector>

namespace recald::simulators {

inline bool is_known_entity(std::string_view text) {
  for (const std::string_view entity : {"&amp;", "&lt;", "&gt;", "&quot;", "&#39;"}) {
    if (text.starts_with(entity)) return true;
  }
  return false;
}

/// Every opened element is closed, in order; no bare ampersand; quotes of attributes are paired;
/// nothing that runs or is fetched.
inline ::testing::AssertionResult is_plain_xml(std::string_view xml) {
  std::vector<std::string> open;
  for (std::size_t at = 0; at < xml.size(); ++at) {
    if (xml[at] == '&' && !is_known_entity(xml.substr(at))) {
      return ::testing::AssertionFailure() << "bare & at " << at;
    }
    if (xml[at] != '<') continue;
    const std::size_t end = xml.find('>', at);
    if (end == std::string_view::npos) return ::testing::AssertionFailure() << "< without >";
    const std::string_view tag = xml.substr(at + 1, end - at - 1);
    if (std::count(tag.begin(), tag.end(), '"') % 2 != 0 || tag.find('<') != tag.npos) {
      return ::testing::AssertionFailure() << "odd tag <" << tag << ">";
    }
    const std::string name(tag.substr(tag.starts_with('/') ? 1 : 0, tag.find_first_of(" /", 1)));
    if (tag.starts_with('/')) {
      if (open.empty() || open.back() != tag.substr(1)) {
        return ::testing::AssertionFailure() << "<" << tag << "> closes nothing";
      }
      open.pop_back();
    } else if (!tag.ends_with('/')) {
      open.push_back(name);
    }
    at = end;
  }
  if (!open.empty()) return ::testing::AssertionFailure() << "<" << open.back() << "> left open";
  for (const std::string_view word : {"script", "href", "url("}) {
    if (xml.find(word) != xml.npos) return ::testing::AssertionFailure() << "holds " << word;
  }
  return ::testing::AssertionSuccess();
}

}  // namespace recald::simulators
