#pragma once

#include <condition_variable>
#include <deque>
#include <functional>
#include <future>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <utility>

#include "study/store/schema/sqlite.h"

namespace passung::store {

/// The one thread that uses the writing connection. Jobs run in the order of their arrival; whoever adds a job waits
/// while kMaxJobs are pending, so that a slow disk slows the session down and never fills the memory. Ends after the
/// last job.
class WriterThread {
public:
    static constexpr std::size_t kMaxJobs = 64;
    using Job = std::function<void(const Database&)>;

    WriterThread(std::string path, std::unique_ptr<Database> database);
    ~WriterThread();
    WriterThread(const WriterThread&) = delete;
    WriterThread& operator=(const WriterThread&) = delete;

    const std::string& path() const { return path_; }

    /// Queues a job; @pre it does not throw.
    void post(Job job);

    /// Runs `work(database)` in the thread and waits for its value or for the error that it threw.
    template <class Work>
    auto call(Work work) -> Result<decltype(work(std::declval<const Database&>()))> {
        using Value = decltype(work(std::declval<const Database&>()));
        std::promise<Result<Value>> promise;
        auto result = promise.get_future();
        post([&](const Database& database) { promise.set_value(guarded(path_, [&] { return work(database); })); });
        return result.get();
    }

private:
    void runJobs();

    std::string path_;
    std::unique_ptr<Database> database_;
    std::mutex mutex_;
    std::condition_variable job_added_;
    std::condition_variable job_taken_;
    std::deque<Job> jobs_;
    bool ending_ = false;
    std::thread thread_;
};

}  // namespace passung::store
