// Does the work of the rendering thread, one step at a time: the scene, its pictures, and what is read from
// them.
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <vector>

#include "apps/view/picture_order.h"
#include "apps/view/shown_picture.h"

namespace limn::app {

/// Renders the pictures of the viewer. All calls come from one thread, in whose context `device` is.
class PictureStudio {
 public:
  /// Takes two callbacks: `publish` gets the facts whenever they changed; `news` is called from other threads
  /// when step() has something to do.
  PictureStudio(gpu::Device& device, std::filesystem::path shaders, std::filesystem::path cache,
                std::function<void(const PictureFacts&)> publish, std::function<void()> news);

  /// Opens another scene. Where that fails the old one goes on; the program ends if the scene is needed. An
  /// order that starts from one that failed is followed without what that one asked for.
  void open(const OpenOrder& order);
  /// Shows what is ordered, as far as it need not wait for anything. When `outdated` says that something else
  /// is wanted, a frame that has begun is abandoned between two of its passes. If every frame is outdated
  /// because things move, the picture is made smaller; the smallest one is never abandoned.
  void step(const PictureOrder& order, const std::function<bool()>& outdated);
  void save(const SaveOrder& order);
  /// Saves the next frame of a sequence.
  void saveNext();
  void cancelSaving();
  bool saving() const { return sequence_.has_value(); }

 private:
  struct Sequence {
    SaveOrder order;
    int frame;
  };
  void say(std::string message, bool problem = false);
  void publish();
  std::unique_ptr<ShownPicture> makePicture(const session::View& view);
  SceneQuestion withoutRefused(const OpenOrder& order) const;
  void reloadShaders();
  void place(const PictureOrder& order);
  using Outcome = ShownPicture::Outcome;
  Outcome render(const PictureOrder& order, const std::function<bool()>& cancelled = {});
  Outcome renderShot(ShownPicture& picture, const render::Settings& settings, const PictureOrder& order,
                     const std::function<bool()>& cancelled, Shot& shot);
  Outcome renderBeside(const render::Settings& settings, const PictureOrder& order,
                       const std::function<bool()>& cancelled, Shot& shot);
  void describeLights();
  void describe(const PictureOrder& order);
  void inspect(const PictureOrder& order);
  bool inspectAtRest(const PictureOrder& order);
  bool follow(const PictureOrder& order, const std::function<bool()>& outdated);
  std::string wantedTruth(const PictureOrder& order);
  bool followReference(const PictureOrder& order);
  bool noMetrics(const char* why);
  bool compare(const PictureOrder& order);
  PictureOrder exposed(PictureOrder order) const;
  bool meter(const PictureOrder& order);
  bool smooth(const PictureOrder& order, const std::function<bool()>& outdated);
  Image renderWhole(const PictureOrder& order);
  Image renderNext(const PictureOrder& order);
  void write(const SaveOrder& order, const std::filesystem::path& file, bool follows = false);
  void finishSaving(std::string message, bool problem = false);

  gpu::Device& device_;
  std::filesystem::path shaders_;
  std::function<void(const PictureFacts&)> publish_;
  std::shared_ptr<session::View> view_;
  std::vector<std::filesystem::path> files_;  ///< that the scene is read from
  std::unique_ptr<ShownPicture> picture_, other_;
  std::optional<SceneQuestion> refused_;  ///< the last order's scene, where it could not be opened as it is
  std::optional<SceneQuestion> placed_;   ///< whose lights the scene has
  std::optional<PictureOrder> rendered_;
  int reduction_ = 1;      ///< of the last picture
  double wholeMs_ = 0;     ///< estimate for a frame that is not reduced
  double lastReload_ = 0;  ///< seconds
  ReferenceWorker reference_;
  std::string truthKey_;  ///< what the reference was asked
  std::optional<Image> truth_;
  ToneMapping truthTone_;                      ///< with which it is shown
  float exposureEv_ = 0;                       ///< the automatic one
  bool metered_ = false;                       ///< exposureEv_ is that of what is shown
  std::optional<Image> smooth_, smoothOther_;  ///< what is shown, with several samples in each pixel
  bool compared_ = false;                      ///< the metrics are of what is shown
  std::optional<Sequence> sequence_;
  std::optional<float> sequenceEv_;  ///< the automatic exposure of its first picture
  PictureFacts facts_;
  uint64_t printed_ = 0;  ///< facts_.messages when one was last printed
};

}  // namespace limn::app
