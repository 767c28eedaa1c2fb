#include "reconstruction/pipeline/surveying_source.h"

namespace tarsus {

Expected<std::optional<RgbdFrame>> SurveyingSource::next() {
  auto frame = source_.next();
  if (frame && *frame && !(*frame)->color.pixels().empty()) {
    pictures_.push_back(assessPicture(**frame));
  }
  return frame;
}

}  // namespace tarsus
