// Work that takes a while, in a thread of its own, one after the other.
#pragma once

#include <condition_variable>
#include <deque>
#include <functional>
#include <mutex>
#include <thread>

namespace mote::viewer {

class TaskQueue {
  public:
    static constexpr std::size_t max_tasks = 16;  ///< that wait

    TaskQueue() : thread_([this] { run(); }) {}
    ~TaskQueue();  ///< waits for the task at work alone
    TaskQueue(const TaskQueue&) = delete;
    TaskQueue& operator=(const TaskQueue&) = delete;

    /// Throws InputError where too many wait. The task throws nothing.
    void add(std::function<void()> task);

  private:
    void run();

    std::mutex mutex_;
    std::condition_variable added_;
    std::deque<std::function<void()>> tasks_;
    bool quit_ = false;
    std::thread thread_;
};

}  // namespace mote::viewer
