#pragma once

#include <QtCore/QObject>
#include <QtCore/QThreadPool>
#include <exception>
#include <memory>
#include <utility>

#include "core/base/result.h"

namespace passung::window {

/// Does jobs one after another in a thread of its own, so that no window waits for a disk. What comes of a job is
/// brought back to the thread of this object.
class Worker : public QObject {
public:
    Worker() { pool_.setMaxThreadCount(1); }
    /// Waits for the running job; those behind it are not begun, and nobody is told any more.
    ~Worker() override {
        pool_.clear();
        pool_.waitForDone();
    }

    /// `job` returns a Result, which `then` takes; what it throws is an error like others.
    template <class Job, class Then>
    void run(Job job, Then then) {
        ++jobs_;
        pool_.start([this, job = std::move(job), then = std::move(then)] {
            using Answer = decltype(job());
            // shared_ptr: what goes through the event loop has to be copied, and not every answer can be.
            const auto answer = std::make_shared<Answer>(answerOf<Answer>(job));
            QMetaObject::invokeMethod(
                this,
                [this, then, answer] {
                    --jobs_;
                    then(std::move(*answer));
                },
                Qt::QueuedConnection);
        });
    }

    bool busy() const { return jobs_ > 0; }

private:
    template <class Answer, class Job>
    static Answer answerOf(const Job& job) {
        try {
            return job();
        } catch (const std::exception& thrown) {
            return Error{.message = thrown.what()};
        }
    }

    QThreadPool pool_;
    int jobs_ = 0;
};

}  // namespace passung::window
