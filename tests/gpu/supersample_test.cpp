// Pixels as means over their areas, against the area that a straight edge leaves in closed form.
#include "core/render/supersample.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <random>

#include "core/reference/reference.h"
#include "core/scene/camera.h"
#include "core/scene/mip_chain.h"
#include "tests/gpu/render_test.h"
#include "tests/support/gltf_builder.h"
#include "tests/support/scene_nodes.h"

namespace limn {
namespace {

constexpr int kSquare = 16;

/// The part of a unit square at (x, y) in which a u + b v < c: the square clipped by the line.
double areaBelow(double x, double y, double a, double b, double c) {
  const std::array<glm::dvec2, 4> square{glm::dvec2(x, y), {x + 1, y}, {x + 1, y + 1}, {x, y + 1}};
  const auto inside = [&](glm::dvec2 p) { return c - a * p.x - b * p.y; };
  std::vector<glm::dvec2> clipped;
  for (size_t i = 0; i < 4; ++i) {
    const glm::dvec2 p = square[i], q = square[(i + 1) % 4];
    const double sp = inside(p), sq = inside(q);
    if (sp > 0) clipped.push_back(p);
    if (sp * sq < 0) clipped.push_back(p + (q - p) * (sp / (sp - sq)));
  }
  double twice = 0;
  for (size_t i = 0; i < clipped.size(); ++i) {
    const glm::dvec2 p = clipped[i], q = clipped[(i + 1) % clipped.size()];
    twice += p.x * q.y - p.y * q.x;
  }
  return 0.5 * std::abs(twice);
}

class SupersampleTest : public RenderTest {
 protected:
  /// A triangle in z = 0 of radiance 1, whose edge crosses the picture: x + 2 y = 0.3 in the square from -1
  /// to 1 that the camera sees.
  SupersampleTest() {
    test::GltfBuilder b;
    b.append("materials",
             {{"emissiveFactor", {1, 1, 1}}, {"pbrMetallicRoughness", {{"baseColorFactor", {0, 0, 0, 1}}}}});
    const int positions = b.vec3({{-5.7f, 3, 0}, {-5.7f, -3, 0}, {6.3f, -3, 0}});
    b.meshNode(b.mesh({{"POSITION", positions}}, -1, 0));
    scene_ = scene::loadMemory(b.glb(), {});
    camera_ = scene::lookAt({0, 0, 5}, glm::vec3(0), static_cast<float>(2 * std::atan(0.2)));
  }

  static double area(int x, int yFromTop) {
    const double pixel = 2.0 / kSquare;
    return areaBelow(x, kSquare - 1 - yFromTop, pixel, 2 * pixel, 0.3 + 3);  // with u, v from the lower left
  }

  scene::Scene scene_;
  scene::CameraPose camera_;
};

TEST_F(SupersampleTest, AnEdgeShowsTheAreaBesideIt) {
  render::Renderer renderer(device(), scene_);
  renderer.configure(settings(kSquare, kSquare, Term::final));
  double before = 1;
  for (const int aa : {1, 2, 4, 8}) {
    const Image picture = render::supersample(renderer, camera_, {kSquare, kSquare}, aa);
    double worst = 0, sum = 0;
    for (int y = 0; y < kSquare; ++y)
      for (int x = 0; x < kSquare; ++x) {
        const double error = static_cast<double>(picture.at(x, y, 0)) - area(x, y);
        worst = std::max(worst, std::abs(error));
        sum += error;
      }
    EXPECT_LT(worst, 0.6 / aa) << aa;
    EXPECT_LT(worst, before) << aa;
    EXPECT_LE(std::abs(sum), 0.5 * kSquare / aa) << aa << ": in each column half the distance of two samples";
    before = worst;
  }
}

TEST_F(SupersampleTest, TheReferenceHasTheSameSamples) {
  render::Renderer renderer(device(), scene_);
  render::Settings s = settings(kSquare, kSquare, Term::final);
  s.channels = true;
  renderer.configure(s);
  for (const int aa : {2, 3}) {
    const Image picture = render::supersample(renderer, camera_, {kSquare, kSquare}, aa);
    const scene::Pose pose = scene::evaluate(scene_, 0);
    reference::Request asked = test::request(scene_, pose, camera_, glm::ivec2(kSquare), Term::final, 1);
    asked.aa = aa;
    const Image truth = reference::render(asked).image;
    for (int y = 0; y < kSquare; ++y)
      for (int x = 0; x < kSquare; ++x) {
        EXPECT_NEAR(picture.at(x, y, 0), truth.at(x, y, 0), 1e-6f) << aa << ' ' << x << ' ' << y;
        EXPECT_NEAR(picture.at(x, y, picture.channel("A")), picture.at(x, y, 0), 1e-6f) << "of radiance 1";
        for (const char* channel : {"coverage", "id", "A"})
          EXPECT_EQ(picture.at(x, y, picture.channel(channel)), truth.at(x, y, truth.channel(channel)))
              << channel << ' ' << aa << ' ' << x << ' ' << y;
      }
  }
}

/// Black and clear or white and opaque texels by chance, two to the side of a pixel: each sample looks them
/// up at level 1, since pictures are averaged of frames with a sample in each pixel. At level 0 values differ
/// by 0.1, and masks by more.
TEST_F(SupersampleTest, TexturesAreAtTheLevelOfAPixelInBoth) {
  constexpr int texels = 2 * kSquare;
  scene::TextureImage image;
  scene::TextureImage::Level level{texels, texels, {}};
  std::mt19937 random(1);
  for (int i = 0; i < texels * texels; ++i)
    level.rgba.insert(level.rgba.end(), 4, random() % 2 == 0 ? uint8_t{0} : uint8_t{255});
  image.levels.push_back(level);
  scene::buildMipChain(image);
  for (const bool mask : {false, true}) {
    SCOPED_TRACE(mask ? "a mask" : "a colour");
    scene::Scene scene;
    scene.images.push_back(image);
    scene::Material material = test::lambertian(0);
    material.emission = glm::vec3(1);
    (mask ? material.baseColourTexture : material.emissiveTexture) = {0, scene::Wrap::clamp,
                                                                      scene::Wrap::clamp};
    if (mask) material.alphaCutoff = 0.6f;
    test::show(scene, test::quad({0, 0, 0}, {2, 0, 0}, {0, 2, 0}, test::addMaterial(scene, material)));
    const scene::Pose pose = scene::evaluate(scene, 0);
    render::Renderer renderer(device(), scene);
    renderer.configure(settings(kSquare, kSquare, Term::final));
    for (const int aa : {1, 2, 3}) {
      const Image picture = render::supersample(renderer, camera_, {kSquare, kSquare}, aa);
      reference::Request asked = test::request(scene, pose, camera_, glm::ivec2(kSquare), Term::final, 1);
      asked.aa = aa;
      const Image truth = reference::render(asked).image;
      double difference = 0, sum = 0;
      for (int y = 0; y < kSquare; ++y)
        for (int x = 0; x < kSquare; ++x) {
          difference += std::abs(static_cast<double>(picture.at(x, y, 0) - truth.at(x, y, 0)));
          sum += static_cast<double>(truth.at(x, y, 0));
        }
      EXPECT_GT(sum / (kSquare * kSquare), 0.1) << aa;
      EXPECT_LT(difference / (kSquare * kSquare), 0.01) << aa;
    }
  }
}

TEST_F(SupersampleTest, OneSampleIsTheFrameToTheBit) {
  const scene::Scene scene = asset("cornell_box");
  render::Renderer renderer(device(), scene);
  render::Settings s = settings(24, 16, Term::final, {quick("pcss")});
  s.channels = true;
  const Image frame = picture(renderer, s);
  const Image single = render::supersample(renderer, renderer.pose().cameras.at(0), s.size, 1);
  EXPECT_TRUE(std::ranges::equal(frame.data(), single.data()));
  // And after several samples the renderer has its camera again.
  render::supersample(renderer, renderer.pose().cameras.at(0), s.size, 2);
  renderer.render();
  EXPECT_TRUE(std::ranges::equal(frame.data(), renderer.read().data()));
}

}  // namespace
}  // namespace limn
