#include "measurement/outline/outline_editor.h"

#include "measurement/outline/curve_contact.h"
#include "measurement/outline/smooth_line.h"

#include <algorithm>

namespace tarsus {
namespace {

/// Cut out around the first click: holds most wounds and what surrounds them.
constexpr double kFirstPatch_mm = 25.0;

bool same(const SurfacePoint& a, const SurfacePoint& b) {
  return a.face == b.face && a.barycentric == b.barycentric;
}

OutlineProblem tooFew(std::size_t count, const Eigen::Vector3d& at_mm) {
  return {.error = {.code = ErrorCode::OutlineInvalid,
                    .detail = std::to_string(count) + " points placed; at least 3 are needed"},
          .at_mm = at_mm};
}

}  // namespace

OutlineEditor::OutlineEditor(std::shared_ptr<const TexturedMesh> foot,
                             std::shared_ptr<const MeshIndex> index)
    : foot_(std::move(foot)),
      index_(std::move(index)),
      others_(std::make_shared<const std::vector<OtherWound>>()),
      local_(foot_->mesh, kFirstPatch_mm) {}

Expected<OutlineEditor> OutlineEditor::besides(std::span<const WoundOutline> others) const {
  auto known = std::make_shared<std::vector<OtherWound>>();
  for (const WoundOutline& other : others) {
    if (other.mesh_sha256 != foot_->sha256) {
      return fail(ErrorCode::OutlineInvalid, "another wound's outline is of another model");
    }
    GrowingPatch around(foot_->mesh);
    around.cover(positionsOf(foot_->mesh, other.curve));
    const OutlinePiece piece{.way = other.curve, .problem = {}};
    const OutlinePiece* const all = &piece;
    auto traced = closePieces(around, std::span(&all, 1));
    if (!traced) {
      return tl::unexpected(traced.error().error);
    }
    known->push_back({.curve = other.curve, .inside = std::move(traced->inside)});
    known->back().curve.push_back(other.curve.front());
  }
  OutlineEditor next = *this;
  next.others_ = std::move(known);
  next.judge();
  return next;
}

OutlineEditor OutlineEditor::with(OutlineClicks clicks) const {
  OutlineEditor next = *this;
  next.clicks_ = std::move(clicks);
  next.local_.cover(positionsOf(foot_->mesh, next.clicks_.points));
  const std::size_t count = next.clicks_.points.size();
  const std::size_t pieces = count < 2 ? 0 : next.clicks_.closed ? count : count - 1;
  next.pieces_.clear();
  for (std::size_t i = 0; i < pieces; ++i) {
    next.pieces_.push_back(next.pieceFrom(i, *this));
  }
  next.judge();
  return next;
}

OutlineEditor OutlineEditor::refusing(OutlineProblem problem) const {
  OutlineEditor next = *this;
  next.problem_ = std::move(problem);
  return next;
}

std::vector<std::vector<SurfacePoint>> OutlineEditor::line() const {
  std::vector<std::vector<SurfacePoint>> line;
  for (const auto& piece : pieces_) {
    line.push_back(piece->piece.way);
    line.back().push_back(piece->clicks[2]);
  }
  return line;
}

std::shared_ptr<const OutlineEditor::KeyedPiece> OutlineEditor::pieceFrom(
    std::size_t click, const OutlineEditor& before) {
  const auto& points = clicks_.points;
  const std::size_t count = points.size();
  const auto at = [&](std::size_t i) { return points[i % count]; };
  KeyedPiece made{.clicks = {at(click), at(click), at(click + 1), at(click + 1)},
                  .smooth = clicks_.smooth,
                  .piece = {}};
  if (clicks_.smooth && (clicks_.closed || click > 0)) {
    made.clicks[0] = at(click + count - 1);
  }
  if (clicks_.smooth && (clicks_.closed || click + 2 < count)) {
    made.clicks[3] = at(click + 2);
  }
  for (const auto& known : before.pieces_) {
    if (known->smooth == made.smooth &&
        std::equal(known->clicks.begin(), known->clicks.end(), made.clicks.begin(), same)) {
      return known;
    }
  }
  made.piece = made.smooth ? traceSmoothPiece(local_, made.clicks)
                           : tracePiece(local_, made.clicks[1], made.clicks[2]);
  return std::make_shared<const KeyedPiece>(std::move(made));
}

void OutlineEditor::judge() {
  outline_.reset();
  problem_.reset();
  for (const auto& piece : pieces_) {
    if (piece->piece.problem) {
      problem_ = piece->piece.problem;
      return;
    }
  }
  if (clicks_.closed) {
    problem_ = close();
  } else if (!pieces_.empty()) {
    const auto open = simpleCurve(local_.patch(), chain(), CurveEnds::Open);
    if (!open) {
      problem_ = OutlineProblem{open.error().error, open.error().at_mm};
    }
  }
  if (!problem_) {
    problem_ = contactWithOthers();
  }
  if (problem_) {
    outline_.reset();
  }
}

std::vector<SurfaceNode> OutlineEditor::chain() const {
  std::vector<SurfaceNode> nodes;
  for (const auto& piece : pieces_) {
    const auto way = nodesOf(local_.patch(), piece->piece.way);
    nodes.insert(nodes.end(), way.begin(), way.end());
  }
  if (!clicks_.points.empty()) {
    const auto& last = clicks_.closed ? clicks_.points.front() : clicks_.points.back();
    nodes.push_back(clickNode(local_.patch(), last));
  }
  return nodes;
}

std::optional<OutlineProblem> OutlineEditor::close() {
  if (clicks_.points.size() < 3) {
    return tooFew(clicks_.points.size(),
                  clicks_.points.empty() ? Eigen::Vector3d::Zero().eval()
                                         : positionOf(foot_->mesh, clicks_.points.back()));
  }
  std::vector<const OutlinePiece*> pieces;
  for (const auto& piece : pieces_) {
    pieces.push_back(&piece->piece);
  }
  auto traced = closePieces(local_, pieces);
  if (!traced) {
    return traced.error();
  }
  traced->outline.mesh_sha256 = foot_->sha256;
  traced->outline.clicks = clicks_.points;
  outline_ = std::make_shared<const TracedOutline>(std::move(*traced));
  return std::nullopt;
}

std::optional<OutlineProblem> OutlineEditor::contactWithOthers() const {
  const auto overlap = [](const Eigen::Vector3d& at_mm) {
    return OutlineProblem{
        .error = {.code = ErrorCode::OutlinesOverlap, .detail = "near " + placeText(at_mm)},
        .at_mm = at_mm};
  };
  const std::vector<SurfaceNode> own = chain();
  for (const OtherWound& other : *others_) {
    if (const auto at = contactOf(local_.patch(), own, nodesOf(local_.patch(), other.curve))) {
      return overlap(*at);
    }
    const auto holds = [](const std::vector<int>& faces, const SurfacePoint& point) {
      return std::binary_search(faces.begin(), faces.end(), static_cast<int>(point.face));
    };
    for (const SurfacePoint& point : clicks_.points) {
      if (holds(other.inside, point)) {
        return overlap(positionOf(foot_->mesh, point));
      }
    }
    for (const SurfacePoint& point : other.curve) {
      if (outline_ && holds(outline_->inside, point)) {
        return overlap(positionOf(foot_->mesh, point));
      }
    }
  }
  return std::nullopt;
}

}  // namespace tarsus
