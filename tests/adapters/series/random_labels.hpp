/// Values of labels that somebody could give a meter, in UTF-8.
#pragma once

#include <random>
#include <string>

namespace recald::testing {

/// One to twelve characters, most of them such as protocols escape.
inline std::string random_label(std::mt19937_64& generator) {
  static const std::string pieces[]{",",  "=",    " ", "\"", "'", "\\", "\n", "\r",
                                    "\t", "\x7f", "#", "{",  "}", ";",  "/",  "a",
                                    "Z",  "7",    "ü", "水", "🏢", "n",  "i"};
  std::uniform_int_distribution<std::size_t> count{1, 12};
  std::uniform_int_distribution<std::size_t> piece{0, std::size(pieces) - 1};
  std::string label;
  for (std::size_t left = count(generator); left > 0; --left) label += pieces[piece(generator)];
  return label;
}

}  // namespace recald::testing
