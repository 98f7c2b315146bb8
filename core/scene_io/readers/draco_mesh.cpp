#include "core/scene_io/readers/draco_mesh.h"

#include <draco/compression/decode.h>
#include <fmt/format.h>

#include <cstring>
#include <memory>

#include "core/base/error.h"

namespace limn::scene {
namespace {

std::unique_ptr<draco::Mesh> decoded(const DracoMesh& mesh) {
  draco::DecoderBuffer buffer;
  buffer.Init(reinterpret_cast<const char*>(mesh.bytes.data()), mesh.bytes.size());
  draco::Decoder decoder;
  auto result = decoder.DecodeMeshFromBuffer(&buffer);
  if (!result.ok())
    throw Error(fmt::format("not a mesh that Draco decodes ({})", result.status().error_msg()));
  return std::move(result).value();
}

template <class Component>
void append(const draco::PointAttribute& source, const DracoMesh& mesh, const DracoAttribute& wanted,
            std::vector<std::byte>& arrays) {
  const std::size_t start = arrays.size(), element = wanted.components * sizeof(Component);
  arrays.resize(start + mesh.attributeBytes(wanted));
  std::vector<Component> values(wanted.components);
  for (std::uint64_t i = 0; i < mesh.vertices; ++i) {
    const draco::AttributeValueIndex value =
        source.mapped_index(draco::PointIndex(static_cast<std::uint32_t>(i)));
    if (value.value() >= source.size() ||
        !source.ConvertValue<Component>(value, static_cast<std::int8_t>(wanted.components), values.data()))
      throw Error(
          fmt::format("attribute {} of vertex {} cannot be stored as the accessor says", wanted.id, i));
    std::memcpy(arrays.data() + start + i * element, values.data(), element);
  }
}

void appendAttribute(const draco::Mesh& source, const DracoMesh& mesh, const DracoAttribute& wanted,
                     std::vector<std::byte>& arrays) {
  const draco::PointAttribute* attribute = source.GetAttributeByUniqueId(wanted.id);
  if (attribute == nullptr) throw Error(fmt::format("it has no attribute {}", wanted.id));
  if (static_cast<std::uint32_t>(attribute->num_components()) != wanted.components)
    throw Error(fmt::format("its attribute {} has {} components; the accessor has {}", wanted.id,
                            static_cast<int>(attribute->num_components()), wanted.components));
  switch (wanted.componentType) {
    case 5120:
      return append<std::int8_t>(*attribute, mesh, wanted, arrays);
    case 5121:
      return append<std::uint8_t>(*attribute, mesh, wanted, arrays);
    case 5122:
      return append<std::int16_t>(*attribute, mesh, wanted, arrays);
    case 5123:
      return append<std::uint16_t>(*attribute, mesh, wanted, arrays);
    case 5125:
      return append<std::uint32_t>(*attribute, mesh, wanted, arrays);
    default:
      return append<float>(*attribute, mesh, wanted, arrays);
  }
}

void appendIndices(const draco::Mesh& source, std::vector<std::byte>& arrays) {
  for (draco::FaceIndex i(0); i < source.num_faces(); ++i)
    for (const draco::PointIndex& corner : source.face(i)) {
      const std::uint32_t index = corner.value();
      const auto bytes = std::as_bytes(std::span(&index, 1));
      arrays.insert(arrays.end(), bytes.begin(), bytes.end());
    }
}

}  // namespace

void decodeDracoMesh(const DracoMesh& mesh, std::vector<std::byte>& arrays) {
  const std::unique_ptr<draco::Mesh> source = decoded(mesh);
  if (std::uint64_t{source->num_faces()} * 3 != mesh.indices)
    throw Error(fmt::format("it has {} indices; the accessor has {}", std::uint64_t{source->num_faces()} * 3,
                            mesh.indices));
  if (source->num_points() != mesh.vertices)
    throw Error(
        fmt::format("it has {} vertices; the accessors have {}", source->num_points(), mesh.vertices));
  appendIndices(*source, arrays);
  for (const DracoAttribute& attribute : mesh.attributes) appendAttribute(*source, mesh, attribute, arrays);
}

}  // namespace limn::scene
