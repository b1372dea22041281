#include "adapters/views/frame/assets.hpp"

#include <zlib.h>

#include <cassert>
#include <numeric>
#include <string>

#include "adapters/views/frame/packed_assets.hpp"

namespace recald::views {
namespace {

std::string unpack_texts(const PackedAssets& packed) {
  std::string text(std::accumulate(packed.sizes.begin(), packed.sizes.end(), std::size_t{0}), '\0');
  auto size = static_cast<uLongf>(text.size());
  [[maybe_unused]] const int ended =
      uncompress(reinterpret_cast<Bytef*>(text.data()), &size,
                 reinterpret_cast<const Bytef*>(packed.deflated.data()),
                 static_cast<uLong>(packed.deflated.size()));
  assert(ended == Z_OK && size == text.size());
  return text;
}

}  // namespace

const Assets& assets() {
  static const std::string text = unpack_texts(packed_assets());
  static const Assets kAssets = [] {
    const PackedAssets& packed = packed_assets();
    std::size_t begin = 0;
    const auto next = [&](std::size_t size) {
      const std::string_view part = std::string_view{text}.substr(begin, size);
      begin += size;
      return part;
    };
    // Initialisers in braces are evaluated in their order.
    return Assets{.script = next(packed.sizes[0]),
                  .style = next(packed.sizes[1]),
                  .charts = next(packed.sizes[2]),
                  .licences = next(packed.sizes[3]),
                  .script_hash = packed.script_hash,
                  .style_hash = packed.style_hash,
                  .gzip_bytes = packed.gzip_bytes};
  }();
  return kAssets;
}

}  // namespace recald::views
