// Declares frame services: a service makes what several techniques may request (shadow maps, virtual lights,
// caustic rays) once per frame, however many request it. The renderer drives all services by one protocol:
//
//     FrameServices services;  // core/render/services.h adds those of limn
//     {
//       const auto building = services.begin(graph, handles, pose);  // while it lives, requests are taken
//       services.get<shadow::ShadowMapService>().request(lights, {});
//       inputs.service<shadow::ShadowMapService>().request(lights, {});  // the same in a technique
//     }
//     if (services.update(graph, pose)) ...  // before each frame; true: build the graph again
//     services.waited();                     // when the GPU has done all work that was asked of it
//     services.givenUp();                    // after a frame of which not all passes ran
//
// A service receives the graph only by these calls and keeps no pointer to it, so that no pointer can dangle.
#pragma once

#include <concepts>
#include <memory>
#include <optional>
#include <string_view>
#include <typeinfo>
#include <utility>
#include <vector>

#include "core/base/export.h"
#include "core/frame/frame_graph.h"
#include "core/gpu_scene/scene_handles.h"

namespace limn {

namespace scene {
struct Pose;
}
class FrameServices;

/// Holds what services need to declare passes while a graph is built.
struct FrameContext {
  frame::FrameGraph& graph;
  SceneHandles handles;
  const scene::Pose& pose;  ///< state at the time of building
  const FrameServices& services;
};

/// Provides what several techniques may request. A service is a derived class that also has `static constexpr
/// const char* serviceName`, its name in messages.
class LIMN_API FrameService {
 public:
  FrameService() = default;
  virtual ~FrameService();
  FrameService(const FrameService&) = delete;
  FrameService& operator=(const FrameService&) = delete;

 protected:
  /// Returns the context of the graph that is being built. Throws Error when no graph is being built.
  const FrameContext& context() const;

 private:
  friend class FrameServices;
  /// Starts a graph: called when it begins to be built. Requests of the previous graph, whose handles are
  /// invalid, are to be forgotten. context() is already valid.
  virtual void begin() = 0;
  /// Updates the service: called before each frame, after GpuScene::update(), with the graph that was built
  /// last. Brings buffers to `pose` and touches in the graph what changed. Returns true to request that the
  /// graph is built again.
  virtual bool update(frame::FrameGraph& graph, const scene::Pose& pose);
  /// Notes that the program has waited until the GPU had done all work that was asked of it. A frame may have
  /// no such moment, or several, also before its last pass.
  virtual void waited();
  /// Notes that the frame of the last update() was given up before all of its passes ran.
  virtual void givenUp();

  std::optional<FrameContext> context_;
};

template <class S>
concept NamedService = std::derived_from<S, FrameService> && requires {
  { S::serviceName } -> std::convertible_to<std::string_view>;
};

/// Holds the services of one renderer, in the order in which they begin and are updated.
class LIMN_API FrameServices {
 public:
  FrameServices();
  ~FrameServices();
  FrameServices(FrameServices&&) noexcept;
  FrameServices& operator=(FrameServices&&) noexcept;

  /// Makes a service and returns it. Throws Error when there is already one of that type.
  template <NamedService S, class... Arguments>
  S& add(Arguments&&... arguments) {
    auto made = std::make_unique<S>(std::forward<Arguments>(arguments)...);
    S& service = *made;
    add(typeid(S), S::serviceName, std::move(made));
    return service;
  }

  /// Returns the service of that type. Throws Error that names it when there is none.
  template <NamedService S>
  S& get() const {
    return static_cast<S&>(find(typeid(S), S::serviceName));
  }

  /// Keeps the services open for requests during its lifetime.
  class LIMN_API Building {
   public:
    ~Building();
    Building(const Building&) = delete;
    Building& operator=(const Building&) = delete;

   private:
    friend class FrameServices;
    explicit Building(FrameServices& services) : services_(services) {}
    Building(FrameServices& services, const FrameContext& context);

    FrameServices& services_;
  };
  /// Lets the services declare their passes in `graph`; the previous graph must be gone.
  [[nodiscard]] Building begin(frame::FrameGraph& graph, const SceneHandles& handles,
                               const scene::Pose& pose);
  /// Calls FrameService::update() of all services. Returns true when a service requests that the graph is
  /// built again.
  bool update(frame::FrameGraph& graph, const scene::Pose& pose);
  /// Calls FrameService::waited() of all services.
  void waited();
  /// Calls FrameService::givenUp() of all services.
  void givenUp();

 private:
  struct Entry {
    const std::type_info* type;
    const char* name;
    std::unique_ptr<FrameService> service;
  };
  void add(const std::type_info& type, const char* name, std::unique_ptr<FrameService> service);
  FrameService& find(const std::type_info& type, const char* name) const;

  std::vector<Entry> entries_;
};

}  // namespace limn
