#include "viewer/task_queue.h"

#include "core/objects/error.h"

namespace mote::viewer {

TaskQueue::~TaskQueue() {
    {
        const std::lock_guard lock(mutex_);
        quit_ = true;
    }
    added_.notify_all();
    thread_.join();
}

void TaskQueue::add(std::function<void()> task) {
    {
        const std::lock_guard lock(mutex_);
        if (tasks_.size() >= max_tasks) throw core::InputError("too many questions at once");
        tasks_.push_back(std::move(task));
    }
    added_.notify_one();
}

void TaskQueue::run() {
    for (;;) {
        std::function<void()> task;
        {
            std::unique_lock lock(mutex_);
            added_.wait(lock, [&] { return quit_ || !tasks_.empty(); });
            if (quit_) return;
            task = std::move(tasks_.front());
            tasks_.pop_front();
        }
        task();
    }
}

}  // namespace mote::viewer
