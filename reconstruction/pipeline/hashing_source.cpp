#include "reconstruction/pipeline/hashing_source.h"

namespace tarsus {

HashingSource::HashingSource(std::unique_ptr<FrameSource> source)
    : source_(std::move(source)), hash_(source_->camera()) {}

Expected<std::optional<RgbdFrame>> HashingSource::next() {
  auto frame = source_->next();
  if (frame && *frame) {
    hash_.add(**frame);
  }
  return frame;
}

}  // namespace tarsus
