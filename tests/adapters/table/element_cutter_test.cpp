#include "adapters/table/element_cutter.hpp"

#include <gtest/gtest.h>

namespace recald::table::element_cutter_test {
namespace {

/// Hands out so many bytes at a time.
csv::ByteSource in_pieces(std::string_view text, std::size_t piece) {
  return [text, piece](char* buffer, std::size_t size) mutable -> Result<std::size_t> {
    const std::size_t got = std::min({piece, size, text.size()});
    std::copy_n(text.data(), got, buffer);
    text.remove_prefix(got);
    return got;
  };
}

std::vector<std::string> cut(std::string_view text, std::size_t piece, std::string& error) {
  ElementCutter cutter{in_pieces(text, piece), {"row"}, 1000};
  std::vector<std::string> elements;
  for (std::string_view element; cutter.next(element);) elements.emplace_back(element);
  error = cutter.error() ? cutter.error()->message : "";
  return elements;
}

constexpr std::string_view kText =
    "<?xml version=\"1.0\"?><!-- <row>no</row> --><a b=\"x > y\"><row r=\"1\">one</row>"
    "<x:row r=\"/>\"/><rows>no</rows><![CDATA[<row>no</row>]]><row\n>two</row ></a>";

TEST(ElementCutter, FindsWholeElementsWhateverThePieces) {
  for (std::size_t piece = 1; piece <= kText.size(); ++piece) {
    std::string error;
    EXPECT_EQ(cut(kText, piece, error),
              (std::vector<std::string>{"<row r=\"1\">one</row>", "<x:row r=\"/>\"/>",
                                        "<row\n>two</row >"}))
        << piece;
    EXPECT_EQ(error, "");
  }
}

// The text cut at every byte: what was whole before the cut comes, and nothing half.
TEST(ElementCutter, CutAnywhereItHandsOutNothingHalf) {
  std::string error;
  const auto whole = cut(kText, 7, error);
  for (std::size_t length = 0; length < kText.size(); ++length) {
    const auto some = cut(kText.substr(0, length), 7, error);
    ASSERT_LE(some.size(), whole.size());
    for (std::size_t i = 0; i < some.size(); ++i) EXPECT_EQ(some[i], whole[i]) << length;
  }
}

TEST(ElementCutter, AnElementWithoutEndOrBeyondMeasureIsAnError) {
  std::string error;
  EXPECT_TRUE(cut("<a><row>one", 5, error).empty());
  EXPECT_EQ(error, "it ends within <row>");
  const std::string large = "<row>" + std::string(200'000, 'x') + "</row>";
  EXPECT_TRUE(cut(large, 70'000, error).empty());
  EXPECT_EQ(error, "one element is larger than can be read");
}

}  // namespace
}  // namespace recald::table::element_cutter_test
