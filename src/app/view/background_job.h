#ifndef VERDURE_APP_VIEW_BACKGROUND_JOB_H_
#define VERDURE_APP_VIEW_BACKGROUND_JOB_H_

#include <chrono>
#include <condition_variable>
#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

namespace verdure::app {

/// One thread that does what was asked for last, beside the one that draws. What it finds is handed
/// over between frames: no state is shared but what a job takes along and hands over.
class BackgroundJob {
 public:
  /// What a job may say and ask while it runs.
  class Control {
   public:
    /// Says how far it is; `share` < 0: unknown. Throws to end the job if it was cancelled, or,
    /// when `gives_way`, if a newer one waits. Jobs let that pass.
    void show(const std::string& step, double share, bool gives_way = false);
    /// `result` will be called by poll(), unless the job is cancelled before.
    void handOver(std::function<void()> result);

   private:
    friend class BackgroundJob;
    explicit Control(BackgroundJob& job) : job_(&job) {}
    BackgroundJob* job_;
  };
  using Work = std::function<void(Control&)>;

  /// `wake` is called, from any thread, when poll() has something to do or the status is another.
  explicit BackgroundJob(std::function<void()> wake = {});
  /// Cancels, and waits until the running job has noticed.
  ~BackgroundJob();
  BackgroundJob(const BackgroundJob&) = delete;
  BackgroundJob& operator=(const BackgroundJob&) = delete;

  /// Does `work` after what is running; one that still waited is dropped.
  void start(std::string title, Work work);
  /// Ends what is running as soon as it says something, drops what waits and what was handed over.
  void cancel();
  /// Calls what was handed over, in order, on the calling thread.
  void poll();

  bool busy() const;  ///< something runs, waits or was handed over
  struct Status {
    std::string title, step;
    double share = -1.0;
  };
  std::optional<Status> status() const;  ///< of what runs, or is about to
  /// What the last failed job threw, once.
  std::optional<std::string> takeError();

 private:
  struct Cancelled {};
  struct Request {
    std::string title;
    Work work;
  };
  void run();

  std::function<void()> wake_;
  mutable std::mutex mutex_;
  std::condition_variable asked_;
  std::optional<Request> waiting_;
  std::vector<std::function<void()>> results_;
  std::optional<Status> status_;
  std::optional<std::string> error_;
  std::chrono::steady_clock::time_point woken_{};  ///< by what a job said
  bool cancelled_ = false;                         ///< what runs
  bool closing_ = false;
  std::thread thread_;  ///< last: it uses the others
};

}  // namespace verdure::app

#endif  // VERDURE_APP_VIEW_BACKGROUND_JOB_H_
