#pragma once

#include "measurement/outline/outline_trace.h"

#include <array>
#include <memory>
#include <optional>
#include <span>
#include <vector>

namespace tarsus {

/// What the clinician placed; all else of an outline follows from it.
struct OutlineClicks {
  std::vector<SurfacePoint> points;
  bool closed = false;
  bool smooth = false;  ///< a smooth curve through the clicks; else shortest ways between them
};

/// An outline being drawn on a model: its clicks, the line through them, what is wrong with it, and
/// where it is closed and sound the outline with its area and perimeter. A value that never
/// changes: an edit makes the next one, which keeps every piece of line whose clicks stayed, so
/// that it costs the same on a large model as on a small one. Old values serve to undo; copies
/// share what is large. The edits themselves are in outline_edits.h.
class OutlineEditor {
 public:
  OutlineEditor(std::shared_ptr<const TexturedMesh> foot, std::shared_ptr<const MeshIndex> index);

  /// The same outline, kept apart from those of other wounds on this model.
  /// @errors OutlineInvalid where one of them was not traced on it
  [[nodiscard]] Expected<OutlineEditor> besides(std::span<const WoundOutline> others) const;
  /// The outline through other clicks, to be drawn even where it has a problem.
  /// @param clicks  points of the model's surface
  [[nodiscard]] OutlineEditor with(OutlineClicks clicks) const;
  /// The same outline after an edit that could not be made at all.
  [[nodiscard]] OutlineEditor refusing(OutlineProblem problem) const;

  [[nodiscard]] const OutlineClicks& clicks() const { return clicks_; }
  [[nodiscard]] const std::optional<OutlineProblem>& problem() const { return problem_; }
  /// With hash and clicks; null while it is open or has a problem. A smooth outline is written to a
  /// file by the positions of its curve: its clicks alone would be joined straight.
  [[nodiscard]] std::shared_ptr<const TracedOutline> outline() const { return outline_; }
  /// The line from click i to the next, in order; one fewer than clicks while it is open.
  [[nodiscard]] std::vector<std::vector<SurfacePoint>> line() const;

  [[nodiscard]] const TexturedMesh& foot() const { return *foot_; }
  [[nodiscard]] const MeshIndex& index() const { return *index_; }
  /// The neighbourhood, for what else is to be found on the surface.
  [[nodiscard]] const GrowingPatch& local() const { return local_; }

 private:
  /// A piece and the clicks it depends on: its own two, smooth lines also those before and after.
  struct KeyedPiece {
    std::array<SurfacePoint, 4> clicks;
    bool smooth = false;
    OutlinePiece piece;
  };
  struct OtherWound {
    std::vector<SurfacePoint> curve;  ///< closed: the first point once more at the end
    std::vector<int> inside;
  };

  [[nodiscard]] std::shared_ptr<const KeyedPiece> pieceFrom(std::size_t click,
                                                            const OutlineEditor& before);
  void judge();
  /// The whole line; a closed one ends where it began.
  [[nodiscard]] std::vector<SurfaceNode> chain() const;
  [[nodiscard]] std::optional<OutlineProblem> close();
  [[nodiscard]] std::optional<OutlineProblem> contactWithOthers() const;

  std::shared_ptr<const TexturedMesh> foot_;
  std::shared_ptr<const MeshIndex> index_;
  std::shared_ptr<const std::vector<OtherWound>> others_;
  GrowingPatch local_;
  OutlineClicks clicks_;
  std::vector<std::shared_ptr<const KeyedPiece>> pieces_;
  std::optional<OutlineProblem> problem_;
  std::shared_ptr<const TracedOutline> outline_;
};

}  // namespace tarsus
