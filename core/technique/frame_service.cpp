#include "core/technique/frame_service.h"

#include <fmt/format.h>

#include <string>

#include "core/base/error.h"

namespace limn {

FrameService::~FrameService() = default;

const FrameContext& FrameService::context() const {
  if (!context_) throw Error("a service was asked while no frame graph was built");
  return *context_;
}

bool FrameService::update(frame::FrameGraph&, const scene::Pose&) {
  return false;
}

void FrameService::waited() {}

void FrameService::givenUp() {}

FrameServices::FrameServices() = default;
FrameServices::~FrameServices() = default;
FrameServices::FrameServices(FrameServices&&) noexcept = default;
FrameServices& FrameServices::operator=(FrameServices&&) noexcept = default;

/// Delegates, so that a service that throws leaves no context behind.
FrameServices::Building::Building(FrameServices& services, const FrameContext& context) : Building(services) {
  for (const Entry& entry : services_.entries_) {
    entry.service->context_.emplace(context);
    entry.service->begin();
  }
}

FrameServices::Building::~Building() {
  for (const Entry& entry : services_.entries_) entry.service->context_.reset();
}

FrameServices::Building FrameServices::begin(frame::FrameGraph& graph, const SceneHandles& handles,
                                             const scene::Pose& pose) {
  return {*this, {graph, handles, pose, *this}};
}

bool FrameServices::update(frame::FrameGraph& graph, const scene::Pose& pose) {
  bool rebuild = false;
  for (const Entry& entry : entries_) rebuild = entry.service->update(graph, pose) || rebuild;
  return rebuild;
}

void FrameServices::waited() {
  for (const Entry& entry : entries_) entry.service->waited();
}

void FrameServices::givenUp() {
  for (const Entry& entry : entries_) entry.service->givenUp();
}

void FrameServices::add(const std::type_info& type, const char* name, std::unique_ptr<FrameService> service) {
  for (const Entry& entry : entries_)
    if (*entry.type == type) throw Error(fmt::format("the service '{}' is there already", name));
  entries_.push_back({&type, name, std::move(service)});
}

FrameService& FrameServices::find(const std::type_info& type, const char* name) const {
  std::string names;
  for (const Entry& entry : entries_) {
    if (*entry.type == type) return *entry.service;
    names += fmt::format("{}'{}'", names.empty() ? "" : ", ", entry.name);
  }
  throw Error(fmt::format("there is no service '{}'; there are: {}", name, names.empty() ? "none" : names));
}

}  // namespace limn
