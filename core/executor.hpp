/// How core runs a loop whose turns are independent, without owning a thread.
#pragma once

#include <cstddef>
#include <functional>

namespace recald {

/// Calls `body(i)` for each i in [0, count), in any order, and returns when all are done.
/// The caller chooses threads; results must not depend on the choice.
using ForEachIndex =
    std::function<void(std::size_t count, const std::function<void(std::size_t)>& body)>;

/// The default: one after the other, in this thread.
inline void for_each_index_serially(std::size_t count,
                                    const std::function<void(std::size_t)>& body) {
  for (std::size_t i = 0; i < count; ++i) body(i);
}

}  // namespace recald
