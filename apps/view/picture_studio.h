// What the rendering thread does, one step at a time: the scene, the pictures of it, what is read of them.
#pragma once

#include <functional>
#include <memory>

#include "apps/view/picture_order.h"
#include "apps/view/shown_picture.h"
#include "apps/view/texture_pool.h"

namespace limn::app {

/// All of it happens on one thread, in whose context `device` is.
class PictureStudio {
 public:
  /// `publish` is given the facts whenever they changed; `news` is called from other threads when step() has
  /// something to do.
  PictureStudio(gpu::Device& device, std::filesystem::path shaders, std::filesystem::path cache,
                std::function<void(const PictureFacts&)> publish, std::function<void()> news);

  void open(const SceneOptions& wanted);
  /// Shows what is ordered, as far as nothing has to be waited for. A frame that has begun is given up
  /// between two of its passes when `outdated` says that something else is wanted; one that something else is
  /// always wanted of, because things move, is then made smaller, and the smallest is never given up.
  void step(const PictureOrder& order, const std::function<bool()>& outdated);
  void save(const SaveOrder& order);
  /// The next frame of a sequence.
  void saveNext();
  void cancelSaving();
  bool saving() const { return sequence_.has_value(); }

 private:
  struct Sequence {
    SaveOrder order;
    int frame;
  };
  void say(std::string message);
  void publish();
  std::unique_ptr<ShownPicture> makePicture(const View& view);
  void reloadShaders();
  void place(const PictureOrder& order);
  using Outcome = ShownPicture::Outcome;
  Outcome render(const PictureOrder& order, const std::function<bool()>& cancelled = {});
  Outcome renderShot(ShownPicture& picture, const render::Settings& settings, const PictureOrder& order,
                     const std::function<bool()>& cancelled, Shot& shot);
  void describe();
  void inspect(const PictureOrder& order);
  bool inspectAtRest(const PictureOrder& order);
  bool follow(const PictureOrder& order, const std::function<bool()>& outdated);
  bool followReference(const PictureOrder& order);
  bool noMetrics(const char* why);
  bool compare(const PictureOrder& order);
  void write(const SaveOrder& order, const std::filesystem::path& file);
  void finishSaving(std::string message);

  gpu::Device& device_;
  std::filesystem::path shaders_;
  std::function<void(const PictureFacts&)> publish_;
  TexturePool pool_;
  std::shared_ptr<View> view_;
  std::unique_ptr<ShownPicture> picture_, other_;
  std::optional<SceneOptions> placed_;  ///< whose lights the scene has
  std::optional<PictureOrder> rendered_;
  int reduction_ = 1;      ///< of the last picture
  double wholeMs_ = 0;     ///< estimate for a frame that is not reduced
  double lastReload_ = 0;  ///< seconds
  ReferenceWorker reference_;
  std::string truthKey_;  ///< what the reference was asked
  std::optional<Image> truth_;
  float truthExposure_ = 0;  ///< EV, with which it is shown
  bool compared_ = false;    ///< the metrics are of what is shown
  std::optional<Sequence> sequence_;
  PictureFacts facts_;
  uint64_t printed_ = 0;  ///< facts_.messages when one was last printed
};

}  // namespace limn::app
