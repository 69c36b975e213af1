#include "tests/support/rt_guard.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sched.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <cmath>
#include <condition_variable>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <iostream>
#include <map>
#include <memory>
#include <mutex>
#include <new>
#include <semaphore>
#include <shared_mutex>
#include <string>
#include <thread>
#include <vector>

namespace passung::support {
namespace {

// Keeps the compiler from removing an allocation whose result nobody looks at.
void keep(volatile void* p) { asm volatile("" : : "g"(p) : "memory"); }

/// Counts of one call of `act` under a guard.
template <class Act>
RtCounts countsOf(Act act) {
    RtGuard guard;
    act();
    return guard.counts();
}

struct RtGuardTest : ::testing::Test {
    void SetUp() override {
        if (!RtGuard::available()) GTEST_SKIP() << "the sanitizer owns malloc";
    }
};

TEST_F(RtGuardTest, CountsNothingForPlainArithmetic) {
    // Truth: invariant (mathematics on the stack allocates, locks and writes nothing)
    std::array<double, 64> values{};
    RtGuard guard;
    for (std::size_t i = 0; i < values.size(); ++i) values[i] = std::sin(static_cast<double>(i));
    keep(values.data());
    EXPECT_EQ(guard.violations(), 0) << guard.describe();
    EXPECT_EQ(guard.clockReads(), 0);
}

TEST_F(RtGuardTest, CountsEveryWayToAllocate) {
    // Truth: closed form (one planted allocation and one release each)
    const std::map<const char*, std::function<void()>> planted = {
        {"malloc",
         [] {
             void* p = std::malloc(40);
             keep(p);
             std::free(p);
         }},
        {"calloc",
         [] {
             void* p = std::calloc(4, 10);
             keep(p);
             std::free(p);
         }},
        {"aligned_alloc",
         [] {
             void* p = std::aligned_alloc(64, 64);
             keep(p);
             std::free(p);
         }},
        {"posix_memalign",
         [] {
             void* p = nullptr;
             if (posix_memalign(&p, 64, 64) == 0) keep(p);
             std::free(p);
         }},
        {"new",
         [] {
             auto p = std::make_unique<double>(1.0);
             keep(p.get());
         }},
        {"new[]",
         [] {
             auto p = std::make_unique<double[]>(100);
             keep(p.get());
         }},
        {"aligned new",
         [] {
             void* p = ::operator new (64, std::align_val_t{64});
             keep(p);
             ::operator delete (p, std::align_val_t{64});
         }},
        {"string",
         [] {
             std::string s(100, 'x');
             keep(s.data());
         }},
        {"vector",
         [] {
             std::vector<double> v;
             v.push_back(1.0);
             keep(v.data());
         }},
        {"function",
         [] {
             std::array<double, 8> big{};
             std::function<double()> f = [big] { return big[0]; };
             keep(&f);
         }},
        {"shared_ptr",
         [] {
             auto p = std::make_shared<int>(1);
             keep(p.get());
         }},
    };
    for (const auto& [name, act] : planted) {
        const RtCounts c = countsOf(std::ref(act));
        EXPECT_EQ(c.allocations, 1) << name;
        EXPECT_EQ(c.deallocations, 1) << name;
    }
}

TEST_F(RtGuardTest, CountsGrowthOfAVector) {
    // Truth: invariant (a full vector must move to new memory and release the old)
    std::vector<double> v(8);
    v.shrink_to_fit();
    const RtCounts c = countsOf([&] {
        v.push_back(1.0);
        keep(v.data());
    });
    EXPECT_EQ(c.allocations, 1);
    EXPECT_EQ(c.deallocations, 1);
}

TEST_F(RtGuardTest, CountsAReleaseAlone) {
    // Truth: closed form (one free; releasing nothing is no violation)
    void* p = std::malloc(10);
    keep(p);
    void* nothing = nullptr;
    keep(&nothing);
    const RtCounts c = countsOf([&] {
        std::free(p);
        std::free(nothing);
    });
    EXPECT_EQ(c.allocations, 0);
    EXPECT_EQ(c.deallocations, 1);
}

TEST_F(RtGuardTest, CountsAnExceptionAsAllocation) {
    // Truth: invariant (the thrown object lives on the heap)
    const RtCounts c = countsOf([] {
        try {
            throw 1;
        } catch (int) {
        }
    });
    EXPECT_GE(c.allocations, 1);
}

TEST_F(RtGuardTest, CountsEveryWayToLock) {
    // Truth: closed form (one planted call each)
    std::mutex mutex;
    std::shared_mutex shared;
    std::condition_variable condition;
    const std::map<const char*, std::function<void()>> planted = {
        {"lock", [&] { std::lock_guard lock(mutex); }},
        {"try_lock",
         [&] {
             if (mutex.try_lock()) mutex.unlock();
         }},
        {"shared", [&] { std::shared_lock lock(shared); }},
        {"exclusive", [&] { std::unique_lock lock(shared); }},
        {"notify_one", [&] { condition.notify_one(); }},
        {"notify_all", [&] { condition.notify_all(); }},
    };
    for (const auto& [name, act] : planted) EXPECT_EQ(countsOf(std::ref(act)).locks, 1) << name;
}

TEST_F(RtGuardTest, CountsEveryWayToWrite) {
    // Truth: invariant (each planted call is input or output)
    const int null_device = ::open("/dev/null", O_RDWR);
    std::FILE* file = std::fopen("/dev/null", "w");
    ASSERT_GE(null_device, 0);
    ASSERT_NE(file, nullptr);
    char byte = 'x';
    const volatile int seven = 7;
    const std::map<const char*, std::function<void()>> planted = {
        {"write", [&] { EXPECT_EQ(::write(null_device, &byte, 1), 1); }},
        {"read", [&] { EXPECT_EQ(::read(null_device, &byte, 1), 0); }},
        {"fprintf", [&] { std::fprintf(file, "%d", seven); }},
        {"printf", [&] { std::printf("%d\n", seven); }},
        {"puts", [&] { std::puts("planted"); }},
        {"fputs", [&] { std::fputs("planted", file); }},
        {"fputc", [&] { std::fputc(byte, file); }},
        {"fwrite", [&] { std::fwrite(&byte, 1, 1, file); }},
        {"fflush", [&] { std::fflush(file); }},
        {"cout", [&] { std::cout << "planted\n"; }},
        {"cerr", [&] { std::cerr << "planted " << seven << '\n'; }},
        {"open", [&] { ::close(::open("/dev/null", O_RDONLY)); }},
        {"fopen", [&] { std::fclose(std::fopen("/dev/null", "r")); }},
    };
    for (const auto& [name, act] : planted) EXPECT_GE(countsOf(std::ref(act)).io, 1) << name;
    std::fclose(file);
    ::close(null_device);
}

TEST_F(RtGuardTest, CountsWaitsAndClockReads) {
    // Truth: closed form (one planted call each; a clock read is no violation)
    EXPECT_EQ(countsOf([] { std::this_thread::sleep_for(std::chrono::nanoseconds(1)); }).waits, 1);
    EXPECT_EQ(countsOf([] { sched_yield(); }).waits, 1);
    RtGuard guard;
    auto now = std::chrono::steady_clock::now();
    keep(&now);
    EXPECT_EQ(guard.clockReads(), 1);
    EXPECT_EQ(guard.violations(), 0) << guard.describe();
}

TEST_F(RtGuardTest, IgnoresOtherThreadsAndWhatComesAfter) {
    // Truth: invariant (counts belong to the constructing thread and to the guard's life)
    std::binary_semaphore go(0);
    std::binary_semaphore done(0);
    std::thread other([&] {
        go.acquire();
        for (int i = 0; i < 100; ++i) keep(std::make_unique<int>(i).get());
        done.release();
    });
    std::int64_t allocations = -1;
    {
        RtGuard guard;
        go.release();
        done.acquire();
        allocations = guard.counts().allocations;
    }
    keep(std::make_unique<int>(1).get());
    RtGuard fresh;
    EXPECT_EQ(allocations, 0);
    EXPECT_EQ(fresh.violations(), 0);
    other.join();
}

TEST_F(RtGuardTest, NamesTheFirstOffender) {
    // Truth: closed form (malloc is planted before free)
    RtGuard guard;
    void* p = std::malloc(10);
    keep(p);
    std::free(p);
    const std::string text = guard.describe();
    EXPECT_NE(text.find("allocations 1, deallocations 1"), std::string::npos) << text;
    EXPECT_NE(text.find("first: malloc called from 0x"), std::string::npos) << text;
    EXPECT_EQ(guard.violations(), 2);
}

}  // namespace
}  // namespace passung::support
