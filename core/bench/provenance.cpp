#include "core/bench/provenance.h"

#include <dlfcn.h>
#include <fmt/format.h>
#include <xxhash.h>

#include <algorithm>
#include <memory>

#include "core/base/error.h"
#include "core/base/file.h"
#include "core/bench/private/provenance_json.h"

namespace limn::bench {

std::string staleness(const Provenance& then, const Provenance& now) {
  if (then.program.empty() && !now.program.empty()) return "an earlier version did not record what it used";
  if (then.program != now.program) return "the program has changed";
  if (then.scene != now.scene) return "the scene has changed";
  if (then.modules.size() != now.modules.size()) return "the techniques have changed";
  for (std::size_t i = 0; i < now.modules.size(); ++i)
    if (then.modules[i].hash != now.modules[i].hash)
      return fmt::format("technique {} has changed", now.modules[i].technique);
  return {};
}

void NewestProvenance::add(const std::string& scene, const Provenance& provenance) {
  if (provenance.program.empty()) return;
  program_ = provenance.program;
  scenes_[scene] = provenance.scene;
  for (const Provenance::Module& m : provenance.modules) modules_[m.technique] = m.hash;
}

bool NewestProvenance::differs(const std::string& scene, const Provenance& provenance) const {
  if (program_.empty()) return false;
  const auto isAnother = [](const auto& newest, const std::string& key, const std::string& hash) {
    const auto found = newest.find(key);
    return found != newest.end() && found->second != hash;
  };
  return provenance.program != program_ || isAnother(scenes_, scene, provenance.scene) ||
         std::ranges::any_of(provenance.modules, [&](const Provenance::Module& m) {
           return isAnother(modules_, m.technique, m.hash);
         });
}

nlohmann::ordered_json provenanceToJson(const Provenance& provenance) {
  nlohmann::ordered_json modules = nlohmann::ordered_json::array();
  for (const Provenance::Module& m : provenance.modules)
    modules.push_back({{"technique", m.technique}, {"file", m.file}, {"hash", m.hash}});
  return {{"program", provenance.program}, {"scene", provenance.scene}, {"techniques", modules}};
}

Provenance provenanceFromJson(const nlohmann::ordered_json& json) {
  Provenance provenance{json.at("program").get<std::string>(), json.at("scene").get<std::string>(), {}};
  for (const nlohmann::ordered_json& m : json.at("techniques"))
    provenance.modules.push_back({m.at("technique").get<std::string>(), m.at("file").get<std::string>(),
                                  m.at("hash").get<std::string>()});
  return provenance;
}

std::string hashOfFiles(std::span<const std::filesystem::path> files) {
  const std::unique_ptr<XXH3_state_t, XXH_errorcode (*)(XXH3_state_t*)> state(XXH3_createState(),
                                                                              XXH3_freeState);
  XXH3_128bits_reset(state.get());
  for (const std::filesystem::path& file : files) {
    const std::vector<std::byte> bytes = readFile(file);
    const std::uint64_t size = bytes.size();
    XXH3_128bits_update(state.get(), &size, sizeof size);
    XXH3_128bits_update(state.get(), bytes.data(), bytes.size());
  }
  const XXH128_hash_t hash = XXH3_128bits_digest(state.get());
  return fmt::format("{:016x}{:016x}", hash.high64, hash.low64);
}

std::filesystem::path fileOfFunction(const void* function) {
  Dl_info info{};
  if (dladdr(function, &info) == 0 || !info.dli_fname) throw Error("a library of limn cannot be found");
  return info.dli_fname;
}

}  // namespace limn::bench
