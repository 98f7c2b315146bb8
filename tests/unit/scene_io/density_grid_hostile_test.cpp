// OpenVDB files made to crash, hang or fill the memory of whoever reads them: one line each.
#include <cstring>
#include <limits>
#include <random>

#include "core/scene_io/private/grid_message.h"
#include "tests/support/vdb_file.h"

namespace limn::test {
namespace {

using openvdb::Coord;
using openvdb::FloatGrid;
using testing::HasSubstr;

constexpr int kMost = std::numeric_limits<int>::max(), kLeast = std::numeric_limits<int>::min();

class HostileVdbFile : public VdbFile {
 protected:
  static FloatGrid::Ptr named(const std::string& name, const std::vector<std::pair<Coord, float>>& voxels) {
    openvdb::initialize();
    auto grid = FloatGrid::create(0.f);
    if (!name.empty()) grid->setName(name);
    for (const auto& [place, value] : voxels) grid->getAccessor().setValue(place, value);
    return grid;
  }
  static FloatGrid::Ptr with(const std::vector<std::pair<Coord, float>>& voxels) {
    return named("density", voxels);
  }

  /// Whatever the file says of its box.
  void expectRefused(const FloatGrid::Ptr& grid, const std::string& part) const {
    for (const bool stats : {true, false}) {
      write({grid}, stats);
      EXPECT_THAT(error(), HasSubstr(part)) << (stats ? "with" : "without") << " a stated box";
    }
  }
};

// Sums of coordinates and a node's size do not fit into 32 bits there.
TEST_F(HostileVdbFile, VoxelsAtTheEndsOfTheIntegers) {
  const std::string accepted = "-2^30 to 2^30 is accepted";
  expectRefused(with({{{kMost, kMost, kMost}, 1}}), accepted);
  expectRefused(with({{{kMost, kMost, kMost}, 1}, {{kMost - 3, kMost - 7, kMost}, 1}}), accepted);
  expectRefused(with({{{kLeast, kLeast, kLeast}, 1}}), accepted);
  expectRefused(with({{{0, 0, kMost}, 1}}), accepted);
  expectRefused(with({{{kLeast, 0, 0}, 1}, {{kMost, 0, 0}, 1}}), accepted);
  expectRefused(with({{{0, (1 << 30) + 1, 0}, 1}}), accepted);
  expectRefused(with({{{-(1 << 30), 0, 0}, 1}, {{1 << 30, 0, 0}, 1}}), "2147483649 x 1 x 1 voxels");
  write(with({{{-(1 << 30), 0, 0}, 1}}));
  EXPECT_EQ(error(), "");
  write(with({{{0, 1 << 30, 1 << 30}, 1}}));
  EXPECT_EQ(error(), "");
}

TEST_F(HostileVdbFile, BoxesLargerThanTheMemory) {
  const auto tiles = with({});
  tiles->sparseFill(openvdb::CoordBBox(Coord(-4096), Coord(4095)), 1.f);  // eight tiles of the root
  expectRefused(tiles, "8192 x 8192 x 8192 voxels; at most 2048 a side");
  // 2048^3 voxels, and their bytes, do not fit into 32 bits.
  expectRefused(with({{Coord(0), 1}, {Coord(2047), 1}}), "2048 x 2048 x 2048 voxels; at most 67108864");
}

TEST_F(HostileVdbFile, ThatUnderstatesItsBox) {
  const auto grid = with({{{0, 0, 0}, 1}, {{1 << 20, 0, 0}, 1}});
  grid->insertMeta(openvdb::GridBase::META_FILE_BBOX_MIN, openvdb::Vec3IMetadata(openvdb::Vec3i(0)));
  grid->insertMeta(openvdb::GridBase::META_FILE_BBOX_MAX, openvdb::Vec3IMetadata(openvdb::Vec3i(1)));
  write({grid}, false);
  EXPECT_THAT(error(), HasSubstr("1048577 x 1 x 1 voxels"));
}

TEST_F(HostileVdbFile, DensitiesThatAreNone) {
  for (const float value : {-1.f, -1e-30f, NAN, INFINITY, -INFINITY, 1.01e30f, 3e38f}) {
    expectRefused(with({{{0, 0, 0}, 1}, {{1, 0, 0}, value}}), "0 to 1e30 is accepted");
    const auto background = openvdb::FloatGrid::create(value);  // of voxels in the box that are not set
    background->setName("density");
    background->getAccessor().setValue({0, 0, 0}, 1);
    background->getAccessor().setValue({2, 0, 0}, 1);
    expectRefused(background, "0 to 1e30 is accepted");
  }
}

TEST_F(HostileVdbFile, OtherTypesAndTransforms) {
  for (const char* type :
       {"Tree_vec3s_5_4_3", "Tree_double_5_4_3", "Tree_bool_5_4_3", "Tree_int32_5_4_3", "Tree_mask_5_4_3"}) {
    const openvdb::GridBase::Ptr grid = emptyGrid(type);
    grid->setName("density");
    write(grid);
    EXPECT_THAT(error(), HasSubstr("no grid of floats")) << type;
  }
  const auto frustum = with({{{0, 0, 0}, 1}});
  frustum->setTransform(
      openvdb::math::Transform::createFrustumTransform(openvdb::BBoxd({0, 0, 0}, {9, 9, 9}), 0.5, 10));
  write(frustum);
  EXPECT_THAT(error(), HasSubstr("affine"));
  write(openvdb::GridPtrVec{});
  EXPECT_THAT(error(), HasSubstr("no grid of floats"));
}

TEST_F(HostileVdbFile, GridsWithoutAName) {
  write(named("", {{{0, 0, 0}, 0.25f}}));
  EXPECT_EQ(scene::readDensityGrid(file()).values, std::vector<float>{0.25f});
  write({named("", {{{0, 0, 0}, 0.25f}}), named("", {{{0, 0, 0}, 0.25f}, {{1, 0, 0}, 0.5f}})}, true);
  EXPECT_EQ(error(), "");
  write({named("", {{{0, 0, 0}, 1}}), named("a", {{{0, 0, 0}, 2}}), with({{{0, 0, 0}, 3}})}, true);
  EXPECT_EQ(scene::readDensityGrid(file()).values, std::vector<float>{3});
  write({named("smoke", {{{0, 0, 0}, 1}}), named("heat", {{{0, 0, 0}, 2}})}, true);
  EXPECT_EQ(scene::readDensityGrid(file()).values, std::vector<float>{2})
      << "the first in the order of names";
}

TEST_F(HostileVdbFile, TakesNoMoreThanIsAllowed) {
  write(with({{{0, 0, 0}, 1}}));
  EXPECT_THAT(error({.time = std::chrono::milliseconds(1)}), HasSubstr("it takes longer than 0.001 s"));
#if !defined(LIMN_SANITIZED)
  EXPECT_THAT(error({.memory = 1 << 20}), HasSubstr("not an OpenVDB file that can be read"));
  write(with({{Coord(0), 1}, {Coord(399), 1}}));
  EXPECT_EQ(error(), "");
  EXPECT_THAT(error({.memory = 256 << 20}), HasSubstr("more memory than the 256 MiB allowed"));
#endif
}

TEST_F(HostileVdbFile, CutOffAnywhere) {
  write(with({{{0, 0, 0}, 1}, {{3, 2, 1}, 0.5f}}));
  const std::vector<std::byte> whole = readFile(file());
  for (std::size_t size = 0; size < whole.size(); size += std::max<std::size_t>(whole.size() / 30, 1)) {
    writeFile(file(), std::span(whole).first(size));
    EXPECT_THAT(error(), HasSubstr("not an OpenVDB file that can be read")) << size;
  }
}

// About one mutant in twenty crashes the library or makes it run for ever.
TEST_F(HostileVdbFile, DamagedAnywhere) {
  const scene::GridLimits limits{.memory = uint64_t{1} << 30, .time = std::chrono::milliseconds(500)};
  std::mt19937 random(5);
  int refused = 0;
  for (const auto compression :
       {openvdb::io::COMPRESS_NONE, openvdb::io::COMPRESS_ZIP, openvdb::io::COMPRESS_BLOSC}) {
    openvdb::io::File out(file().string());
    out.setCompression(compression | openvdb::io::COMPRESS_ACTIVE_MASK);
    out.write(openvdb::GridPtrVec{with({{{0, 0, 0}, 1}, {{3, 2, 1}, 0.5f}})});
    out.close();
    ASSERT_EQ(error(), "");
    const std::vector<std::byte> whole = readFile(file());
    for (int trial = 0; trial < 80; ++trial) {
      std::vector<std::byte> damaged = whole;
      // The first bytes say how many there are of everything.
      const std::size_t range = trial % 2 ? damaged.size() : std::min<std::size_t>(damaged.size(), 1200);
      for (unsigned i = 1 + random() % 4; i > 0; --i)
        damaged[random() % range] = static_cast<std::byte>(random() % 3 ? random() : 0xff * (random() % 2));
      writeFile(file(), damaged);
      refused += !error(limits).empty();
    }
  }
  EXPECT_GT(refused, 100);
}

class GridMessage : public testing::Test {
 protected:
  static std::vector<std::byte> bytesOf(const scene::GridHeader& header, std::span<const std::byte> rest) {
    std::vector<std::byte> bytes(sizeof header);
    std::memcpy(bytes.data(), &header, sizeof header);
    bytes.insert(bytes.end(), rest.begin(), rest.end());
    return bytes;
  }
  static std::string refusal(const std::vector<std::byte>& message, const scene::GridLimits& limits = {}) {
    try {
      scene::decodeGridMessage(message, limits);
    } catch (const Error& thrown) {
      return thrown.what();
    }
    return {};
  }
  scene::DensityGrid grid_{{2, 1, 3}, {1, 2, 3, 4, 5, 6}, glm::mat4(2)};
  scene::GridHeader header_ = scene::headerOf(grid_);
  std::span<const std::byte> values_ = std::as_bytes(std::span(grid_.values));
};

TEST_F(GridMessage, ComesBackAsItWas) {
  const scene::DensityGrid back = scene::decodeGridMessage(bytesOf(header_, values_), {});
  EXPECT_EQ(back.size, grid_.size);
  EXPECT_EQ(back.values, grid_.values);
  EXPECT_EQ(back.worldToBox, grid_.worldToBox);
  const std::string_view reason = "no grid";
  EXPECT_EQ(refusal(bytesOf(scene::headerOf(reason), std::as_bytes(std::span(reason)))), reason);
}

TEST_F(GridMessage, ThatContradictsItselfIsRefused) {
  const auto altered = [&](const std::function<void(scene::GridHeader&)>& change) {
    scene::GridHeader header = header_;
    change(header);
    return refusal(bytesOf(header, values_));
  };
  const auto nothing = HasSubstr("reading it gave no grid");
  EXPECT_THAT(altered([](auto& h) { h.magic[0] = 'L'; }), nothing);
  EXPECT_THAT(altered([](auto& h) { h.kind = 2; }), nothing);
  EXPECT_THAT(altered([](auto& h) { h.size = {2, 1, 4}; }), nothing);
  EXPECT_THAT(altered([](auto& h) { h.size = {-2, -1, 3}; }), nothing);
  EXPECT_THAT(altered([](auto& h) { h.size = {kMost, kMost, kMost}; }), nothing);
  EXPECT_THAT(altered([](auto& h) { h.bytes = 28; }), nothing);
  EXPECT_THAT(altered([](auto& h) { h.worldToBox[3] = NAN; }), nothing);
  EXPECT_THAT(refusal(bytesOf(header_, values_), {.voxels = 5}), nothing);
  EXPECT_THAT(refusal(bytesOf(header_, values_), {.side = 2}), nothing);
  EXPECT_THAT(refusal(bytesOf(header_, values_.first(20))), nothing);
  EXPECT_THAT(refusal({}), nothing);
  EXPECT_THAT(refusal(bytesOf(scene::headerOf(""), {})), nothing);
  const std::string_view odd("\0two\nlines\n", 11);
  EXPECT_EQ(refusal(bytesOf(scene::headerOf(odd), std::as_bytes(std::span(odd)))), "?two?lines");
  grid_.values[4] = -1;
  EXPECT_THAT(refusal(bytesOf(header_, values_)), HasSubstr("a density of -1"));
}

}  // namespace
}  // namespace limn::test
