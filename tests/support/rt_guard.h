#pragma once

#include <cstdint>
#include <string>

namespace passung::support {

/// What one thread did while a guard was alive.
struct RtCounts {
    std::int64_t allocations = 0;    // malloc, calloc, realloc, aligned_alloc, operator new ... and mmap
    std::int64_t deallocations = 0;  // free of something, operator delete, munmap
    std::int64_t locks = 0;          // mutex, reader-writer lock, condition variable, semaphore; wait or try
    std::int64_t io = 0;             // read, write, open, printf, fwrite, streams, sockets ...
    std::int64_t waits = 0;          // sleep, yield
    std::int64_t clock_reads = 0;    // clock_gettime and what uses it; no violation by itself
};

/// Counts what a real-time thread must not do, from construction to destruction, in the constructing thread only:
///
///     RtGuard guard;
///     for (int i = 0; i < 10000; ++i) output = step(model, state, input);
///     EXPECT_EQ(guard.violations(), 0) << guard.describe();
///
/// It works by defining the C library's functions in the test program (link passung_rt_guard), so that calls from
/// every library are seen, except those that the C library makes inside itself. Not nestable.
/// Under AddressSanitizer and ThreadSanitizer, which own the same functions, it counts nothing:
/// `if (!RtGuard::available()) GTEST_SKIP();`
class RtGuard {
public:
    static bool available() noexcept;

    RtGuard() noexcept;
    ~RtGuard();
    RtGuard(const RtGuard&) = delete;
    RtGuard& operator=(const RtGuard&) = delete;

    /// Everything but clock reads. Asking counts nothing.
    std::int64_t violations() const noexcept;
    std::int64_t clockReads() const noexcept { return counts().clock_reads; }
    RtCounts counts() const noexcept;

    /// The counts in words and the first offender: function and return address (for addr2line).
    std::string describe() const;
};

}  // namespace passung::support
