#pragma once

#include <fcntl.h>
#include <sys/mman.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <bit>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <new>
#include <stdexcept>
#include <string>
#include <type_traits>

#include "tests/support/temp_folder.h"

/// Memory that a test shares with a shim of a vendor's library, which may be loaded in another process: what the hand
/// does goes in, what the device has felt comes out, and stays when that process is killed.
namespace passung::fake {

/// A value made of doubles that one side writes and the other reads whole.
template <typename Value>
class SharedValue {
    static_assert(std::is_trivially_copyable_v<Value> && sizeof(Value) % sizeof(double) == 0);
    static constexpr std::size_t kNumbers = sizeof(Value) / sizeof(double);

public:
    SharedValue() noexcept { store(Value{}); }
    void store(const Value& value) noexcept {
        const auto numbers = std::bit_cast<std::array<double, kNumbers>>(value);
        const auto now = version_.load(std::memory_order_relaxed);
        version_.store(now + 1, std::memory_order_seq_cst);
        for (std::size_t i = 0; i < kNumbers; ++i) numbers_[i].store(numbers[i], std::memory_order_seq_cst);
        version_.store(now + 2, std::memory_order_seq_cst);
    }
    Value load() const noexcept {
        std::array<double, kNumbers> numbers;
        for (;;) {
            const auto before = version_.load(std::memory_order_seq_cst);
            for (std::size_t i = 0; i < kNumbers; ++i) numbers[i] = numbers_[i].load(std::memory_order_seq_cst);
            if (before % 2 == 0 && version_.load(std::memory_order_seq_cst) == before) break;
        }
        return std::bit_cast<Value>(numbers);
    }

private:
    std::atomic<std::uint64_t> version_ = 0;
    std::array<std::atomic<double>, kNumbers> numbers_{};
};

/// The last `kRows` values that one side has written, and how many there were.
template <typename Value, std::size_t kRows = 4096>
class SharedRing {
public:
    void push(const Value& value) noexcept {
        const auto count = count_.load(std::memory_order_relaxed);
        rows_[static_cast<std::size_t>(count) % kRows].store(value);
        count_.store(count + 1, std::memory_order_release);
    }
    std::int64_t count() const noexcept { return count_.load(std::memory_order_acquire); }
    /// The row of that number, from 0; one of the last kRows.
    Value row(std::int64_t number) const noexcept { return rows_[static_cast<std::size_t>(number) % kRows].load(); }
    Value last() const noexcept { return count() == 0 ? Value{} : row(count() - 1); }

private:
    std::atomic<std::int64_t> count_ = 0;
    std::array<SharedValue<Value>, kRows> rows_{};
};

/// The variable that says where the block lies in the process that has made it.
inline std::string placeOf(const char* variable) { return std::string(variable) + "_PLACE"; }

/// The test's side: makes the block in a file and names that in an environment variable, which the shim reads.
template <typename Block>
class SharedBlock {
public:
    explicit SharedBlock(const char* variable) : variable_(variable) {
        const std::string path = folder_ / "block";
        const int file = open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0600);
        if (file < 0 || ftruncate(file, sizeof(Block)) != 0) throw std::runtime_error("no file for a shared block");
        memory_ = mmap(nullptr, sizeof(Block), PROT_READ | PROT_WRITE, MAP_SHARED, file, 0);
        close(file);
        if (memory_ == MAP_FAILED) throw std::runtime_error("no memory for a shared block");
        block_ = new (memory_) Block;
        setenv(variable, path.c_str(), 1);
        std::array<char, 64> place{};
        std::snprintf(place.data(), place.size(), "%ld %p", static_cast<long>(getpid()), memory_);
        setenv(placeOf(variable).c_str(), place.data(), 1);
    }
    ~SharedBlock() {
        unsetenv(variable_);
        unsetenv(placeOf(variable_).c_str());
        munmap(memory_, sizeof(Block));
    }
    SharedBlock(const SharedBlock&) = delete;
    SharedBlock& operator=(const SharedBlock&) = delete;

    Block& operator*() { return *block_; }
    Block* operator->() { return block_; }

private:
    test::TempFolder folder_;
    const char* variable_;
    void* memory_ = nullptr;
    Block* block_ = nullptr;
};

/// The shim's side: where the block of the variable lies; null if there is none. In the process of the test that is the
/// same place, so that ThreadSanitizer sees what its semaphores order.
template <typename Block>
Block* findBlock(const char* variable) {
    long process = 0;
    void* place = nullptr;
    const char* text = std::getenv(placeOf(variable).c_str());
    if (text != nullptr && std::sscanf(text, "%ld %p", &process, &place) == 2 && process == static_cast<long>(getpid()))
        return static_cast<Block*>(place);
    const char* path = std::getenv(variable);
    const int file = path == nullptr ? -1 : open(path, O_RDWR | O_CLOEXEC);
    if (file < 0) return nullptr;
    void* memory = mmap(nullptr, sizeof(Block), PROT_READ | PROT_WRITE, MAP_SHARED, file, 0);
    close(file);
    return memory == MAP_FAILED ? nullptr : static_cast<Block*>(memory);
}

}  // namespace passung::fake
