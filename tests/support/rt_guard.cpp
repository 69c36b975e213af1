// The C library's headers must not define inline what is defined here.
#ifndef __NO_INLINE__
#define __NO_INLINE__
#endif
#include "tests/support/rt_guard.h"

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define PASSUNG_RT_GUARD 0
#elif defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer)
#define PASSUNG_RT_GUARD 0
#else
#define PASSUNG_RT_GUARD 1
#endif
#else
#define PASSUNG_RT_GUARD 1
#endif

namespace passung::support {
namespace {

/// One per thread; only the innermost code of this file touches it.
struct Watch {
    bool on = false;
    RtCounts counts;
    const char* first_function = nullptr;
    const void* first_caller = nullptr;
};
thread_local Watch watch;

}  // namespace

bool RtGuard::available() noexcept { return PASSUNG_RT_GUARD != 0; }

RtGuard::RtGuard() noexcept {
    watch = Watch{};
    watch.on = true;
}

RtGuard::~RtGuard() { watch.on = false; }

RtCounts RtGuard::counts() const noexcept { return watch.counts; }

std::int64_t RtGuard::violations() const noexcept {
    const RtCounts& c = watch.counts;
    return c.allocations + c.deallocations + c.locks + c.io + c.waits;
}

std::string RtGuard::describe() const {
    const Watch seen = watch;
    const bool was_on = seen.on;
    watch.on = false;
    char address[2 + 16 + 1] = "0x";
    auto rest = reinterpret_cast<std::uintptr_t>(seen.first_caller);
    for (int i = 17; i >= 2; --i, rest >>= 4) address[i] = "0123456789abcdef"[rest & 15];
    const RtCounts& c = seen.counts;
    std::string text = "allocations " + std::to_string(c.allocations) + ", deallocations " +
                       std::to_string(c.deallocations) + ", locks " + std::to_string(c.locks) + ", io " +
                       std::to_string(c.io) + ", waits " + std::to_string(c.waits) + ", clock reads " +
                       std::to_string(c.clock_reads);
    if (seen.first_function != nullptr) {
        text += std::string("; first: ") + seen.first_function + " called from " + address;
    }
    watch.on = was_on;
    return text;
}

}  // namespace passung::support

#if PASSUNG_RT_GUARD

#include <dlfcn.h>
#include <fcntl.h>
#include <poll.h>
#include <pthread.h>
#include <sched.h>
#include <semaphore.h>
#include <sys/ioctl.h>
#include <sys/mman.h>
#include <sys/socket.h>
#include <sys/uio.h>
#include <time.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstdarg>
#include <cstdio>
#include <cstdlib>

namespace {

using passung::support::RtCounts;
using passung::support::watch;

void note(std::int64_t RtCounts::*kind, const char* function, const void* caller) {
    if (!watch.on) return;
    ++(watch.counts.*kind);
    if (watch.first_function == nullptr && kind != &RtCounts::clock_reads) {
        watch.first_function = function;
        watch.first_caller = caller;
    }
}

/// The next definition of `name` after this program's, looked up once. No static local: its guard may lock.
template <class Function>
Function next(std::atomic<Function>& slot, const char* name) {
    Function function = slot.load(std::memory_order_relaxed);
    if (function == nullptr) {
        const bool was_on = watch.on;
        watch.on = false;
        function = reinterpret_cast<Function>(dlsym(RTLD_NEXT, name));
        watch.on = was_on;
        if (function == nullptr) std::abort();
        slot.store(function, std::memory_order_relaxed);
    }
    return function;
}

}  // namespace

#define NOTE(kind, function) note(&RtCounts::kind, function, __builtin_return_address(0))

// A function of the C library that is counted and then passed on.
#define COUNTED(kind, result, name, parameters, arguments)                \
    extern "C" result name parameters {                                   \
        static constinit std::atomic<result(*) parameters> slot{nullptr}; \
        NOTE(kind, #name);                                                \
        return next(slot, #name) arguments;                               \
    }

// ---- memory: straight to the C library's own entries, because looking a name up may allocate ----

extern "C" {
void* __libc_malloc(std::size_t);
void* __libc_calloc(std::size_t, std::size_t);
void* __libc_realloc(void*, std::size_t);
void* __libc_memalign(std::size_t, std::size_t);
void __libc_free(void*);

void* malloc(std::size_t size) {
    NOTE(allocations, "malloc");
    return __libc_malloc(size);
}
void* calloc(std::size_t count, std::size_t size) {
    NOTE(allocations, "calloc");
    return __libc_calloc(count, size);
}
void* realloc(void* old, std::size_t size) {
    NOTE(allocations, "realloc");
    return __libc_realloc(old, size);
}
void* memalign(std::size_t alignment, std::size_t size) {
    NOTE(allocations, "memalign");
    return __libc_memalign(alignment, size);
}
void* aligned_alloc(std::size_t alignment, std::size_t size) {
    NOTE(allocations, "aligned_alloc");
    return __libc_memalign(alignment, size);
}
int posix_memalign(void** result, std::size_t alignment, std::size_t size) {
    NOTE(allocations, "posix_memalign");
    *result = __libc_memalign(alignment, size);
    return *result == nullptr ? ENOMEM : 0;
}
void free(void* memory) {
    if (memory != nullptr) NOTE(deallocations, "free");
    __libc_free(memory);
}
}

COUNTED(allocations, void*, mmap, (void* a, std::size_t n, int p, int f, int fd, off_t o), (a, n, p, f, fd, o))
COUNTED(deallocations, int, munmap, (void* a, std::size_t n), (a, n))

// ---- locks ----

COUNTED(locks, int, pthread_mutex_lock, (pthread_mutex_t * m), (m))
COUNTED(locks, int, pthread_mutex_trylock, (pthread_mutex_t * m), (m))
COUNTED(locks, int, pthread_rwlock_rdlock, (pthread_rwlock_t * l), (l))
COUNTED(locks, int, pthread_rwlock_wrlock, (pthread_rwlock_t * l), (l))
COUNTED(locks, int, pthread_cond_signal, (pthread_cond_t * c), (c))
COUNTED(locks, int, pthread_cond_broadcast, (pthread_cond_t * c), (c))
COUNTED(locks, int, pthread_cond_wait, (pthread_cond_t * c, pthread_mutex_t* m), (c, m))
COUNTED(locks, int, sem_wait, (sem_t * s), (s))
COUNTED(locks, int, sem_post, (sem_t * s), (s))

// ---- waits and clocks ----

COUNTED(waits, int, nanosleep, (const timespec* t, timespec* r), (t, r))
COUNTED(waits, int, clock_nanosleep, (clockid_t c, int f, const timespec* t, timespec* r), (c, f, t, r))
COUNTED(waits, int, usleep, (useconds_t t), (t))
COUNTED(waits, int, sched_yield, (), ())
COUNTED(waits, int, poll, (pollfd * f, nfds_t n, int t), (f, n, t))
COUNTED(clock_reads, int, clock_gettime, (clockid_t c, timespec* t), (c, t))

// ---- input and output ----

COUNTED(io, ssize_t, write, (int fd, const void* data, std::size_t n), (fd, data, n))
COUNTED(io, ssize_t, writev, (int fd, const iovec* v, int n), (fd, v, n))
COUNTED(io, ssize_t, pwrite, (int fd, const void* data, std::size_t n, off_t o), (fd, data, n, o))
COUNTED(io, ssize_t, read, (int fd, void* data, std::size_t n), (fd, data, n))
COUNTED(io, ssize_t, pread, (int fd, void* data, std::size_t n, off_t o), (fd, data, n, o))
COUNTED(io, ssize_t, send, (int fd, const void* data, std::size_t n, int f), (fd, data, n, f))
COUNTED(io, ssize_t, recv, (int fd, void* data, std::size_t n, int f), (fd, data, n, f))
COUNTED(io, int, close, (int fd), (fd))
COUNTED(io, int, fsync, (int fd), (fd))
COUNTED(io, int, fdatasync, (int fd), (fd))
COUNTED(io, FILE*, fopen, (const char* path, const char* mode), (path, mode))
COUNTED(io, int, fclose, (FILE * f), (f))
COUNTED(io, int, fflush, (FILE * f), (f))
COUNTED(io, std::size_t, fwrite, (const void* d, std::size_t s, std::size_t n, FILE* f), (d, s, n, f))
COUNTED(io, std::size_t, fread, (void* d, std::size_t s, std::size_t n, FILE* f), (d, s, n, f))
COUNTED(io, int, fputs, (const char* text, FILE* f), (text, f))
COUNTED(io, int, fputc, (int c, FILE* f), (c, f))
COUNTED(io, int, putc, (int c, FILE* f), (c, f))
COUNTED(io, int, putchar, (int c), (c))
COUNTED(io, int, puts, (const char* text), (text))
COUNTED(io, int, vprintf, (const char* format, va_list list), (format, list))
COUNTED(io, int, vfprintf, (FILE * f, const char* format, va_list list), (f, format, list))

// With a variable number of arguments; the fortified forms (…_chk) are what printf becomes under _FORTIFY_SOURCE.
extern "C" {
int printf(const char* format, ...) {
    NOTE(io, "printf");
    va_list list;
    va_start(list, format);
    const int result = vfprintf(stdout, format, list);
    va_end(list);
    return result;
}
int fprintf(FILE* file, const char* format, ...) {
    NOTE(io, "fprintf");
    va_list list;
    va_start(list, format);
    const int result = vfprintf(file, format, list);
    va_end(list);
    return result;
}
int __printf_chk(int, const char* format, ...) {
    NOTE(io, "printf");
    va_list list;
    va_start(list, format);
    const int result = vfprintf(stdout, format, list);
    va_end(list);
    return result;
}
int __fprintf_chk(FILE* file, int, const char* format, ...) {
    NOTE(io, "fprintf");
    va_list list;
    va_start(list, format);
    const int result = vfprintf(file, format, list);
    va_end(list);
    return result;
}
int open(const char* path, int flags, ...) {
    NOTE(io, "open");
    va_list list;
    va_start(list, flags);
    const auto mode = (flags & (O_CREAT | O_TMPFILE)) != 0 ? va_arg(list, mode_t) : mode_t{0};
    va_end(list);
    return openat(AT_FDCWD, path, flags, mode);
}
int ioctl(int fd, unsigned long request, ...) {
    using Function = int (*)(int, unsigned long, ...);
    static constinit std::atomic<Function> slot{nullptr};
    NOTE(io, "ioctl");
    va_list list;
    va_start(list, request);
    void* argument = va_arg(list, void*);
    va_end(list);
    return next(slot, "ioctl")(fd, request, argument);
}
}

#endif
