#include "techniques/implicit_visibility/processor_gather.h"

#include "core/radiosity/illumination.h"

namespace limn::implicit_visibility {

ProcessorGather::ProcessorGather(gpu::Device& device, const ElementPasses& elements)
    : elements_(elements),
      exchange_(elements.slots()),
      outgoing_(elements.slots()),
      irradiance_(elements.leafSlots(), glm::vec3(0)),
      irradianceBuffer_(device, "irradiance", elements.leafSlots() * sizeof(glm::vec4),
                        gpu::BufferUse::updated),
      reflectedBuffer_(device, "reflected by leaves", elements.slots() * sizeof(glm::vec4),
                       gpu::BufferUse::updated) {}

void ProcessorGather::gather(const gpu::Buffer& outgoing, const gpu::Buffer& direct) {
  read(outgoing, outgoing_.size());
  for (size_t i = 0; i < outgoing_.size(); ++i) outgoing_[i] = glm::vec3(exchange_[i]);
  gather(outgoing_, {});
  read(direct, irradiance_.size());
  const auto leaves = elements_.elements().leaves();
  for (size_t i = 0; i < irradiance_.size(); ++i)
    exchange_[i] += glm::vec4(leaves[i].albedo * irradiance_[i] * glsl::inverse_pi, 0);
  upload(reflectedBuffer_);
}

void ProcessorGather::gatherEnvironment(std::span<const glm::vec3> environment) {
  gather({}, environment);
}

void ProcessorGather::gather(std::span<const glm::vec3> outgoing, std::span<const glm::vec3> environment) {
  radiosity::gather(elements_.elements().forest(), elements_.links(), elements_.binTable(), outgoing,
                    environment, irradiance_);
  for (size_t i = 0; i < irradiance_.size(); ++i) exchange_[i] = glm::vec4(irradiance_[i], 0);
  upload(irradianceBuffer_);
}

void ProcessorGather::read(const gpu::Buffer& buffer, size_t count) {
  buffer.read(0, exchange_.data(), count * sizeof(glm::vec4));
}

void ProcessorGather::upload(gpu::Buffer& buffer) {
  buffer.update(0, exchange_.data(), irradiance_.size() * sizeof(glm::vec4));
}

}  // namespace limn::implicit_visibility
