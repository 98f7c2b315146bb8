// A plug-in from another interface version: core must refuse it before it reads anything beyond the
// handshake.
#include "core/technique/technique.h"

extern "C" __attribute__((visibility("default"))) const limn::TechniquePlugin* limnTechniquePlugin() {
  static const limn::TechniquePlugin plugin = [] {
    limn::TechniquePlugin made{limn::handshake(), nullptr, nullptr, nullptr};
    made.handshake.interfaceNumber = 99;
    return made;
  }();
  return &plugin;
}
