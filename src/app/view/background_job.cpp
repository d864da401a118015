#include "app/view/background_job.h"

#include <exception>
#include <new>
#include <utility>

namespace verdure::app {

void BackgroundJob::Control::show(const std::string& step, double share, bool gives_way) {
  bool wake = false;
  {
    const std::lock_guard lock(job_->mutex_);
    if (job_->cancelled_ || (gives_way && job_->waiting_)) throw Cancelled{};
    job_->status_->step = step;
    job_->status_->share = share;
    // Frames that only show progress are not to take the time of what makes it.
    const auto now = std::chrono::steady_clock::now();
    wake = job_->wake_ && now - job_->woken_ > std::chrono::milliseconds(150);
    if (wake) job_->woken_ = now;
  }
  if (wake) job_->wake_();
}

void BackgroundJob::Control::handOver(std::function<void()> result) {
  {
    const std::lock_guard lock(job_->mutex_);
    if (job_->cancelled_) throw Cancelled{};
    job_->results_.push_back(std::move(result));
  }
  if (job_->wake_) job_->wake_();
}

BackgroundJob::BackgroundJob(std::function<void()> wake)
    : wake_(std::move(wake)), thread_([this] { run(); }) {}

BackgroundJob::~BackgroundJob() {
  {
    const std::lock_guard lock(mutex_);
    closing_ = cancelled_ = true;
    waiting_.reset();
  }
  asked_.notify_one();
  thread_.join();
}

void BackgroundJob::start(std::string title, Work work) {
  {
    const std::lock_guard lock(mutex_);
    waiting_ = Request{std::move(title), std::move(work)};
  }
  asked_.notify_one();
}

void BackgroundJob::cancel() {
  const std::lock_guard lock(mutex_);
  cancelled_ = status_.has_value();
  waiting_.reset();
  results_.clear();
}

void BackgroundJob::poll() {
  std::vector<std::function<void()>> results;
  {
    const std::lock_guard lock(mutex_);
    results.swap(results_);
  }
  for (const std::function<void()>& result : results) result();
}

bool BackgroundJob::busy() const {
  const std::lock_guard lock(mutex_);
  return status_ || waiting_ || !results_.empty();
}

std::optional<BackgroundJob::Status> BackgroundJob::status() const {
  const std::lock_guard lock(mutex_);
  if (!status_ && waiting_) return Status{waiting_->title, "", -1.0};
  return status_;
}

std::optional<std::string> BackgroundJob::takeError() {
  const std::lock_guard lock(mutex_);
  return std::exchange(error_, std::nullopt);
}

void BackgroundJob::run() {
  std::unique_lock lock(mutex_);
  for (;;) {
    asked_.wait(lock, [this] { return closing_ || waiting_; });
    if (closing_) return;
    const Request request = *std::exchange(waiting_, std::nullopt);
    cancelled_ = false;
    status_ = Status{request.title, "", -1.0};
    lock.unlock();
    std::optional<std::string> error;
    try {
      Control control(*this);
      request.work(control);
    } catch (const Cancelled&) {
      // As asked.
    } catch (const std::bad_alloc&) {
      error = request.title + ": out of memory; use a smaller plant or grid";
    } catch (const std::exception& e) {
      error = e.what();
    }
    lock.lock();
    if (error && !cancelled_) error_ = std::move(error);
    status_.reset();
    if (wake_) {
      lock.unlock();
      wake_();
      lock.lock();
    }
  }
}

}  // namespace verdure::app
