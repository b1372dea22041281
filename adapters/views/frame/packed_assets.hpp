/// What build.mjs writes: the pages' scripts and style, compressed.
#pragma once

#include <array>
#include <cstddef>
#include <string_view>

namespace recald::views {

struct PackedAssets {
  std::string_view
      deflated;  ///< Script, style, charts and licences, one behind the other (RFC 1950).
  std::array<std::size_t, 4> sizes;  ///< Of each in bytes, unpacked.
  std::string_view script_hash;      ///< As in Assets.
  std::string_view style_hash;
  std::size_t gzip_bytes;
};

[[nodiscard]] const PackedAssets& packed_assets();

}  // namespace recald::views
