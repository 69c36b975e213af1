#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <thread>
#include <vector>

namespace passung::geometry {

/// Calls `body(i)` for every i in 0 … count-1 on all cores; the calls must not depend on each other. For builds only.
template <class Body>
void parallelFor(std::size_t count, const Body& body) {
    const std::size_t threads = std::min<std::size_t>(std::max(1u, std::thread::hardware_concurrency()), count);
    if (threads <= 1) {
        for (std::size_t i = 0; i < count; ++i) body(i);
        return;
    }
    std::atomic<std::size_t> next{0};
    std::vector<std::thread> workers;
    for (std::size_t t = 0; t < threads; ++t) {
        workers.emplace_back([&] {
            for (std::size_t i = next.fetch_add(1); i < count; i = next.fetch_add(1)) body(i);
        });
    }
    for (auto& worker : workers) worker.join();
}

}  // namespace passung::geometry
