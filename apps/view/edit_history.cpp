#include "apps/view/edit_history.h"

#include <algorithm>
#include <utility>

#include "apps/view/picture_order.h"
#include "core/question/question_fields.h"

namespace limn::app {

bool same(const Edit& a, const Edit& b) {
  SceneQuestion scene = a.state.scene;
  scene.width = b.state.scene.width;
  scene.height = b.state.scene.height;
  return scene == b.state.scene && a.state.tone == b.state.tone &&
         a.state.automaticExposure == b.state.automaticExposure &&
         same(a.state.techniques, b.state.techniques) && same(a.others, b.others) && a.step == b.step;
}

void EditHistory::restart(Edit present) {
  edits_.clear();
  edits_.push_back(std::move(present));
  present_ = 0;
}

void EditHistory::note(const Edit& present) {
  if (!edits_.empty() && same(edits_[present_], present)) return;
  if (!edits_.empty()) edits_.resize(present_ + 1);
  if (edits_.size() == kMost) edits_.erase(edits_.begin());
  edits_.push_back(present);
  present_ = edits_.size() - 1;
}

void EditHistory::forget(const SceneQuestion& question) {
  const auto gone = [&](const Edit& edit) {
    return sameFields(QuestionEffect::scene, edit.state.scene, question);
  };
  size_t left = 0;  // up to the present one
  for (size_t i = 0; i < edits_.size() && i <= present_; ++i)
    if (!gone(edits_[i])) ++left;
  std::erase_if(edits_, gone);
  present_ = std::max<size_t>(left, 1) - 1;
}

void EditHistory::fillOthers(const std::vector<render::TechniqueUse>& others) {
  for (Edit& edit : edits_)
    if (edit.others.empty()) edit.others = others;
}

void EditHistory::recount(const glm::dvec3& from, const glm::dvec3& to) {
  for (Edit& edit : edits_) edit.orbit.recount(from, to);
}

const Edit* EditHistory::undo() {
  return present_ > 0 ? &edits_[--present_] : nullptr;
}

const Edit* EditHistory::redo() {
  return present_ + 1 < edits_.size() ? &edits_[++present_] : nullptr;
}

}  // namespace limn::app
