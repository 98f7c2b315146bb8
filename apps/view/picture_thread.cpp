#include "apps/view/picture_thread.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include <chrono>
#include <utility>

#include "apps/limn/options.h"
#include "apps/view/picture_studio.h"
#include "core/base/error.h"

namespace limn::app {
namespace {

constexpr std::chrono::milliseconds kIdle{250};  // between looks at the shaders on disk

}  // namespace

struct PictureThread::Mailbox {
  struct Cancel {};
  using Job = std::variant<OpenOrder, SaveOrder, Cancel>;

  std::mutex mutex;
  std::condition_variable_any wake;
  std::optional<PictureOrder> order;
  std::deque<Job> jobs;
  bool news = false;  ///< from another thread that works for this one
  std::shared_ptr<const PictureFacts> facts = std::make_shared<PictureFacts>();

  void publish(const PictureFacts& newest) {
    auto next = std::make_shared<const PictureFacts>(newest);
    {
      const std::scoped_lock lock(mutex);
      facts.swap(next);
    }
    glfwPostEmptyEvent();
  }
  void notify() {
    {
      const std::scoped_lock lock(mutex);
      news = true;
    }
    wake.notify_one();
  }
  std::deque<Job> takeJobs() {
    const std::scoped_lock lock(mutex);
    return std::exchange(jobs, {});
  }
  template <class T>
  void push(T job) {
    {
      const std::scoped_lock lock(mutex);
      jobs.emplace_back(std::move(job));
    }
    wake.notify_one();
  }
};

PictureThread::PictureThread(const PictureThreadOptions& options)
    : options_(options), mailbox_(std::make_unique<Mailbox>()) {
  {
    const ContextScope none(nullptr);  // gives the caller its own back
    context_ = Context::create(
        {.backend = Backend::egl, .device = options.device, .debug = options.debug, .warn = warn});
    device_ = std::make_unique<gpu::Device>(*context_);
  }
  thread_ = std::jthread([this](const std::stop_token& stop) { run(stop); });
}

PictureThread::~PictureThread() {
  thread_.request_stop();
  thread_.join();
}

void PictureThread::run(const std::stop_token& stop) {
  Mailbox& box = *mailbox_;
  try {
    context_->makeCurrent();
    PictureStudio studio(
        *device_, options_.shaders, options_.cache, [&box](const PictureFacts& facts) { box.publish(facts); },
        [&box] { box.notify(); });
    const auto outdated = [&] {
      const std::scoped_lock lock(box.mutex);
      return stop.stop_requested() || box.order || !box.jobs.empty();
    };
    PictureOrder order;
    while (!stop.stop_requested()) {
      std::deque<Mailbox::Job> jobs;
      {
        std::unique_lock lock(box.mutex);
        if (!studio.saving())
          box.wake.wait_for(lock, stop, kIdle, [&] { return box.order || !box.jobs.empty() || box.news; });
        if (box.order) order = std::move(*box.order);
        box.order.reset();
        box.news = false;
        jobs.swap(box.jobs);
      }
      for (const Mailbox::Job& job : jobs) {
        if (const auto* open = std::get_if<OpenOrder>(&job)) studio.open(*open);
        if (const auto* save = std::get_if<SaveOrder>(&job)) studio.save(*save);
        if (std::holds_alternative<Mailbox::Cancel>(job)) studio.cancelSaving();
      }
      studio.saving() ? studio.saveNext() : studio.step(order, outdated);
      context_->throwErrors();
    }
    // A picture that was to be saved when the window was closed is not lost.
    for (const Mailbox::Job& job : box.takeJobs())
      if (const auto* save = std::get_if<SaveOrder>(&job); save && !save->frames) studio.save(*save);
  } catch (...) {
    PictureFacts failed;
    failed.fatal = std::current_exception();
    box.publish(failed);
  }
  Context::release();
}

void PictureThread::show(PictureOrder order) {
  {
    const std::scoped_lock lock(mailbox_->mutex);
    mailbox_->order = std::move(order);
  }
  mailbox_->wake.notify_one();
}

void PictureThread::open(OpenOrder order) {
  mailbox_->push(std::move(order));
}

void PictureThread::save(SaveOrder order) {
  mailbox_->push(std::move(order));
}

void PictureThread::cancelSaving() {
  mailbox_->push(Mailbox::Cancel{});
}

std::shared_ptr<const PictureFacts> PictureThread::facts() const {
  const std::scoped_lock lock(mailbox_->mutex);
  return mailbox_->facts;
}

}  // namespace limn::app
