// Random graphs against the definition of a hazard, pair by pair: every hazard has its barrier bit between
// the two accesses, and no bit can be taken away.
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <random>
#include <set>

#include "core/base/error.h"
#include "core/frame/frame_graph.h"

namespace limn::frame {
namespace {

struct Use {
  int resource;
  Access access;
};
struct Event {
  std::vector<Use> uses;
  GLbitfield bits = 0;
};

bool shaderWrite(Access a) {
  return a == Access::imageStore || a == Access::imageLoadStore;
}
bool replaces(Access a) {
  return a == Access::colourAttachment || a == Access::copyTarget;
}
bool reads(Access a) {
  return a < Access::imageStore;
}
GLbitfield bitOf(Access a) {
  const std::map<Access, GLbitfield> bits{{Access::sampled, GL_TEXTURE_FETCH_BARRIER_BIT},
                                          {Access::imageLoad, GL_SHADER_IMAGE_ACCESS_BARRIER_BIT},
                                          {Access::copySource, GL_TEXTURE_UPDATE_BARRIER_BIT},
                                          {Access::imageStore, GL_SHADER_IMAGE_ACCESS_BARRIER_BIT},
                                          {Access::imageLoadStore, GL_SHADER_IMAGE_ACCESS_BARRIER_BIT},
                                          {Access::colourAttachment, GL_FRAMEBUFFER_BARRIER_BIT},
                                          {Access::colourBlend, GL_FRAMEBUFFER_BARRIER_BIT},
                                          {Access::copyTarget, GL_TEXTURE_UPDATE_BARRIER_BIT}};
  return bits.at(a);
}

/// Whether each hazard that ends in the last frame has its bit on the way.
bool covered(const std::vector<Event>& frame, int frames = 4) {
  std::vector<Event> events;
  for (int i = 0; i < frames; ++i) events.insert(events.end(), frame.begin(), frame.end());
  for (size_t last = events.size() - frame.size(); last < events.size(); ++last) {
    for (const Use& use : events[last].uses) {
      GLbitfield seen = events[last].bits;
      for (size_t first = last; first-- > 0;) {
        bool replaced = false;
        for (const Use& before : events[first].uses) {
          if (before.resource != use.resource) continue;
          const bool hazard = shaderWrite(before.access) || (reads(before.access) && shaderWrite(use.access));
          if (hazard && (seen & bitOf(use.access)) == 0) return false;
          replaced |= replaces(before.access);
        }
        if (replaced) break;
        seen |= events[first].bits;
      }
    }
  }
  return true;
}

struct RandomGraph {
  FrameGraph graph;
  std::map<std::string, std::vector<Use>> uses;
  std::vector<Use> outside;
};

/// Textures of different sizes, so that none share memory.
void build(RandomGraph& random, std::mt19937& engine) {
  const auto pick = [&](int n) { return static_cast<int>(engine() % static_cast<unsigned>(n)); };
  constexpr Access readKinds[] = {Access::sampled, Access::imageLoad, Access::copySource};
  constexpr Access writeKinds[] = {Access::imageStore,       Access::imageLoadStore, Access::colourBlend,
                                   Access::colourAttachment, Access::copyTarget,     Access::imageStore};
  constexpr int textures = 4;
  std::vector<TextureHandle> current;
  for (int t = 0; t < textures; ++t)
    current.push_back(random.graph.createTexture("t" + std::to_string(t), {.width = 8 + t, .height = 8}));
  std::set<int> written;
  const int passes = 2 + pick(9);
  for (int p = 0; p < passes; ++p) {
    const std::string name = "p" + std::to_string(p);
    PassBuilder pass = random.graph.addPass(name);
    if (pick(3) == 0) pass.sideEffect();
    std::set<int> touched;
    for (int i = pick(3); i > 0; --i) {
      const int t = pick(textures);
      if (!written.contains(t) || !touched.insert(t).second) continue;
      const Access access = readKinds[pick(3)];
      pass.read(current[t], access, "");
      random.uses[name].push_back({t, access});
    }
    const int t = pick(textures);
    if (touched.contains(t)) continue;
    const Access access = written.contains(t) ? writeKinds[pick(6)] : writeKinds[3 * pick(2)];
    current[t] = pass.write(current[t], access, "");
    written.insert(t);
    random.uses[name].push_back({t, access});
  }
  for (int t : written) {
    if (pick(3) != 0) continue;
    random.graph.output(current[t]);
    for (Access access : {Access::sampled, Access::imageLoad, Access::copySource, Access::colourBlend})
      random.outside.push_back({t, access});
  }
}

TEST(FrameBarriersRandom, EveryHazardIsCoveredAndNoBitIsSuperfluous) {
  int bits = 0;
  for (unsigned seed = 0; seed < 400; ++seed) {
    std::mt19937 engine(seed);
    RandomGraph random;
    build(random, engine);
    random.graph.plan();
    std::vector<Event> frame;
    for (const PassReport& row : random.graph.explain())
      if (row.state != PassState::leftOut) frame.push_back({random.uses[row.name], row.barriers});
    if (frame.empty()) continue;
    // What the outside blends onto an output comes in order, like what it reads.
    frame.push_back({random.outside, random.graph.finalBarriers()});
    ASSERT_TRUE(covered(frame)) << "seed " << seed;
    for (Event& event : frame) {
      for (GLbitfield rest = event.bits; rest != 0; rest &= rest - 1) {
        const GLbitfield bit = rest & (~rest + 1);
        event.bits &= ~bit;
        EXPECT_FALSE(covered(frame)) << "seed " << seed << " bit " << bit;
        event.bits |= bit;
        ++bits;
      }
    }
  }
  EXPECT_GT(bits, 500);
}

}  // namespace
}  // namespace limn::frame
