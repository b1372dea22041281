#include "adapters/system/parallel_for.hpp"

#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

namespace recald::system {

ForEachIndex parallel_for(unsigned threads) {
  const unsigned available =
      std::max(threads != 0 ? threads : std::thread::hardware_concurrency(), 1u);
  return [available](std::size_t count, const std::function<void(std::size_t)>& body) {
    std::atomic<std::size_t> next{0};
    std::exception_ptr first_error;
    std::mutex error_mutex;
    const auto work = [&] {
      for (std::size_t i = next++; i < count; i = next++) {
        try {
          body(i);
        } catch (...) {
          const std::scoped_lock lock{error_mutex};
          if (!first_error) first_error = std::current_exception();
        }
      }
    };
    {
      std::vector<std::jthread> pool;
      for (std::size_t t = 1; t < std::min<std::size_t>(available, count); ++t) {
        pool.emplace_back(work);
      }
      work();
    }
    if (first_error) std::rethrow_exception(first_error);
  };
}

}  // namespace recald::system
