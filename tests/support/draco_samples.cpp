// limn_draco_samples FOLDER: writes small meshes that Draco has compressed, for the loader's tests. A program
// of its own, since Draco's tinygltf and limn's cannot live in one.
//
// sequential.drc and edgebreaker.drc hold a grid of 5 x 4 vertices over the plane z = 0: position (x, y, x y
// / 8), normal (0.6, 0, 0.8) where x is even, else (0, 0, 1), texture coordinates (x / 4, y / 3), colour (60
// x, 80 y, 7, 255) in bytes; the attributes' ids are 0 to 3 in this order. cloud.drc holds points alone.
#include <draco/compression/encode.h>
#include <draco/mesh/triangle_soup_mesh_builder.h>
#include <draco/point_cloud/point_cloud_builder.h>

#include <array>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <memory>

namespace {

constexpr int kColumns = 4, kRows = 3;

struct Vertex {
  std::array<float, 3> position, normal;
  std::array<float, 2> uv;
  std::array<std::uint8_t, 4> color;
};

Vertex vertex(int x, int y) {
  const float u = static_cast<float>(x), v = static_cast<float>(y);
  Vertex result{{u, v, u * v / 8}, {0, 0, 1}, {u / kColumns, v / kRows}, {}};
  if (x % 2 == 0) result.normal = {0.6f, 0, 0.8f};
  result.color = {static_cast<std::uint8_t>(60 * x), static_cast<std::uint8_t>(80 * y), 7, 255};
  return result;
}

std::unique_ptr<draco::Mesh> grid() {
  draco::TriangleSoupMeshBuilder builder;
  builder.Start(2 * kColumns * kRows);
  const int position = builder.AddAttribute(draco::GeometryAttribute::POSITION, 3, draco::DT_FLOAT32);
  const int normal = builder.AddAttribute(draco::GeometryAttribute::NORMAL, 3, draco::DT_FLOAT32);
  const int uv = builder.AddAttribute(draco::GeometryAttribute::TEX_COORD, 2, draco::DT_FLOAT32);
  const int color = builder.AddAttribute(draco::GeometryAttribute::COLOR, 4, draco::DT_UINT8);
  draco::FaceIndex face(0);
  const auto add = [&](const Vertex& a, const Vertex& b, const Vertex& c) {
    builder.SetAttributeValuesForFace(position, face, &a.position, &b.position, &c.position);
    builder.SetAttributeValuesForFace(normal, face, &a.normal, &b.normal, &c.normal);
    builder.SetAttributeValuesForFace(uv, face, &a.uv, &b.uv, &c.uv);
    builder.SetAttributeValuesForFace(color, face, &a.color, &b.color, &c.color);
    ++face;
  };
  for (int y = 0; y < kRows; ++y)
    for (int x = 0; x < kColumns; ++x) {
      add(vertex(x, y), vertex(x + 1, y), vertex(x, y + 1));
      add(vertex(x, y + 1), vertex(x + 1, y), vertex(x + 1, y + 1));
    }
  return builder.Finalize();
}

void write(const std::filesystem::path& file, const draco::EncoderBuffer& buffer) {
  std::ofstream out(file, std::ios::binary);
  out.write(buffer.data(), static_cast<std::streamsize>(buffer.size()));
  if (!out) std::exit(1);
}

}  // namespace

int main(int count, char** arguments) {
  if (count != 2) return 2;
  const std::filesystem::path folder = arguments[1];
  std::filesystem::create_directories(folder);
  const std::unique_ptr<draco::Mesh> mesh = grid();
  if (!mesh) return 1;
  for (const bool edgebreaker : {false, true}) {
    draco::Encoder encoder;
    encoder.SetEncodingMethod(edgebreaker ? draco::MESH_EDGEBREAKER_ENCODING
                                          : draco::MESH_SEQUENTIAL_ENCODING);
    if (edgebreaker)
      for (const auto type : {draco::GeometryAttribute::POSITION, draco::GeometryAttribute::NORMAL,
                              draco::GeometryAttribute::TEX_COORD})
        encoder.SetAttributeQuantization(type, 14);
    draco::EncoderBuffer buffer;
    if (!encoder.EncodeMeshToBuffer(*mesh, &buffer).ok()) return 1;
    write(folder / (edgebreaker ? "edgebreaker.drc" : "sequential.drc"), buffer);
  }
  draco::PointCloudBuilder points;
  points.Start(3);
  const int position = points.AddAttribute(draco::GeometryAttribute::POSITION, 3, draco::DT_FLOAT32);
  for (std::uint32_t i = 0; i < 3; ++i) {
    const std::array<float, 3> place{static_cast<float>(i), 0, 0};
    points.SetAttributeValueForPoint(position, draco::PointIndex(i), &place);
  }
  draco::EncoderBuffer buffer;
  if (!draco::Encoder().EncodePointCloudToBuffer(*points.Finalize(true), &buffer).ok()) return 1;
  write(folder / "cloud.drc", buffer);
  return 0;
}
