#include "core/technique/frame_service.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "core/base/error.h"
#include "core/scene/scene.h"

namespace limn {
namespace {

using testing::HasSubstr;

/// Calls in order, as "service.call".
using Log = std::vector<std::string>;

/// Declares one pass per graph whoever asks.
class Noise : public FrameService {
 public:
  static constexpr const char* serviceName = "noise";
  explicit Noise(Log& log) : log_(log) {}

  frame::BufferHandle request() {
    if (made_) return made_;
    frame::PassBuilder pass = context().graph.addPass("noise", "test");
    made_ = pass.write(context().graph.createBuffer("noise", {4}), frame::Access::storageStore, "");
    return made_;
  }

 private:
  void begin() override {
    made_ = {};
    log_.push_back("noise.begin");
  }
  bool update(frame::FrameGraph&, const scene::Pose& pose) override {
    log_.push_back("noise.update");
    return !pose.lights.empty();
  }
  void waited() override { log_.push_back("noise.waited"); }
  void givenUp() override { log_.push_back("noise.givenUp"); }

  Log& log_;
  frame::BufferHandle made_;
};

/// Asks another service, and has nothing to update.
class Smooth : public FrameService {
 public:
  static constexpr const char* serviceName = "smooth noise";
  explicit Smooth(Log& log) : log_(log) {}

  frame::BufferHandle request() { return context().services.get<Noise>().request(); }

 private:
  void begin() override { log_.push_back("smooth.begin"); }

  Log& log_;
};

class Failing : public FrameService {
 public:
  static constexpr const char* serviceName = "failing";

 private:
  void begin() override { throw Error("no"); }
};

template <class F>
std::string messageOf(F&& call) {
  try {
    call();
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}

TEST(FrameServices, BeginAndUpdateInTheOrderInWhichTheyWereAdded) {
  Log log;
  FrameServices services;
  services.add<Noise>(log);
  services.add<Smooth>(log);
  frame::FrameGraph graph;
  scene::Pose pose;
  { const auto building = services.begin(graph, {}, pose); }
  EXPECT_FALSE(services.update(graph, pose));
  pose.lights.emplace_back();
  EXPECT_TRUE(services.update(graph, pose)) << "one asks for the graph to be rebuilt";
  EXPECT_THAT(log, testing::ElementsAre("noise.begin", "smooth.begin", "noise.update", "noise.update"));
}

TEST(FrameServices, AreToldHowFramesEnd) {
  Log log;
  FrameServices services;
  services.add<Noise>(log);
  services.add<Smooth>(log);
  services.waited();
  services.givenUp();
  EXPECT_THAT(log, testing::ElementsAre("noise.waited", "noise.givenUp"));
}

TEST(FrameServices, AreFoundByTypeAndShareWhatTheyMadeInAGraph) {
  Log log;
  FrameServices services;
  Noise& noise = services.add<Noise>(log);
  services.add<Smooth>(log);
  EXPECT_EQ(&services.get<Noise>(), &noise);
  const scene::Pose pose;
  for (int i = 0; i < 2; ++i) {
    frame::FrameGraph graph;
    const auto building = services.begin(graph, {}, pose);
    graph.output(services.get<Smooth>().request());
    EXPECT_EQ(services.get<Smooth>().request(), noise.request());
    graph.plan();
    EXPECT_EQ(graph.explain().size(), 1u) << "each graph has the pass once";
  }
}

TEST(FrameServices, AMissingOneIsRefusedByName) {
  Log log;
  FrameServices services;
  EXPECT_EQ(messageOf([&] { services.get<Noise>(); }), "there is no service 'noise'; there are: none");
  services.add<Smooth>(log);
  EXPECT_EQ(messageOf([&] { services.get<Noise>(); }),
            "there is no service 'noise'; there are: 'smooth noise'");
  EXPECT_THAT(messageOf([&] { services.add<Smooth>(log); }), HasSubstr("'smooth noise' is there already"));
}

TEST(FrameServices, CannotBeAskedUnlessAGraphIsBuilt) {
  Log log;
  FrameServices services;
  Noise& noise = services.add<Noise>(log);
  const scene::Pose pose;
  EXPECT_THAT(messageOf([&] { noise.request(); }), HasSubstr("no frame graph was built"));
  {
    frame::FrameGraph graph;
    const auto building = services.begin(graph, {}, pose);
    EXPECT_TRUE(noise.request());
  }
  services.add<Failing>();
  frame::FrameGraph graph;
  EXPECT_THROW(services.begin(graph, {}, pose), Error);
  EXPECT_THAT(messageOf([&] { noise.request(); }), HasSubstr("no frame graph was built"))
      << "a failed beginning leaves no graph behind";
}

}  // namespace
}  // namespace limn
