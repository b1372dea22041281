/// The pages' own scripts and style, bundled at build time by build.mjs and compiled in compressed.
#pragma once

#include <cstddef>
#include <string_view>

namespace recald::views {

struct Assets {
  std::string_view script;       ///< Embedded between <script> tags.
  std::string_view style;        ///< Embedded between <style> tags.
  std::string_view charts;       ///< Of the daemon's pages: a file of its own, licences included.
  std::string_view licences;     ///< Of the libraries in the script; plain text.
  std::string_view script_hash;  ///< For the Content-Security-Policy, "sha256-…".
  std::string_view style_hash;
  std::size_t gzip_bytes;  ///< Script and style together, compressed, as measured by the build.
};

/// Unpacked when they are first asked for, and kept.
[[nodiscard]] const Assets& assets();

}  // namespace recald::views
