#include "study/store/write/writer_thread.h"

namespace passung::store {

WriterThread::WriterThread(std::string path, std::unique_ptr<Database> database)
    : path_(std::move(path)), database_(std::move(database)), thread_([this] { runJobs(); }) {}

WriterThread::~WriterThread() {
    {
        const std::lock_guard lock(mutex_);
        ending_ = true;
    }
    job_added_.notify_one();
    thread_.join();
    try {
        // Closing empties and removes the log, unless somebody reads the file just now: what has ended is in the file
        // itself then, as far as the reader lets it, who removes the log.
        database_->execute("PRAGMA busy_timeout=500; PRAGMA wal_checkpoint(TRUNCATE)");
    } catch (const std::exception&) {
        // The disk refuses: the log keeps everything for the next time.
    }
}

void WriterThread::post(Job job) {
    {
        std::unique_lock lock(mutex_);
        job_taken_.wait(lock, [this] { return jobs_.size() < kMaxJobs; });
        jobs_.push_back(std::move(job));
    }
    job_added_.notify_one();
}

void WriterThread::runJobs() {
    for (;;) {
        Job job;
        {
            std::unique_lock lock(mutex_);
            job_added_.wait(lock, [this] { return ending_ || !jobs_.empty(); });
            if (jobs_.empty()) return;
            job = std::move(jobs_.front());
            jobs_.pop_front();
        }
        job_taken_.notify_one();
        job(*database_);
    }
}

}  // namespace passung::store
