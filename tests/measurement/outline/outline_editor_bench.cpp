#include "measurement/outline/cut.h"
#include "measurement/outline/outline_edits.h"
#include "measurement/outline/painted_border.h"
#include "measurement/outline/stroke.h"
#include "tests/measurement/outline/wound_surface.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <numbers>

namespace tarsus {
namespace {

using std::numbers::pi;

double milliseconds(const auto& work) {
  const auto start = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start)
      .count();
}

struct Spread {
  std::vector<double> ms;
  void add(double value) { ms.push_back(value); }
  [[nodiscard]] double median() {
    std::sort(ms.begin(), ms.end());
    return ms[ms.size() / 2];
  }
  [[nodiscard]] double worst() const { return *std::max_element(ms.begin(), ms.end()); }
};

/// A leg of a million faces, skin as large as a foot's, rough by 0.2 mm.
struct Leg {
  test::Skin skin = test::cylinderSkin(44.0);
  test::Relief relief = test::crater(9.0, 3.0, 1.5);
  std::shared_ptr<const TexturedMesh> foot;
  std::shared_ptr<const MeshIndex> index;

  Leg() {
    foot = std::make_shared<const TexturedMesh>(
        test::woundMesh(skin, relief, {.half_size_mm = 120.0, .edge_mm = 0.34, .noise_mm = 0.2}));
    index = std::make_shared<const MeshIndex>(foot->mesh);
  }
  [[nodiscard]] Eigen::Vector3d at(double s, double t) const {
    const test::SkinPoint p = skin(s, t);
    return p.position - relief(s, t) * p.normal;
  }
};

/// What one edit is made of, each on its own.
void printParts(const Leg& leg, const OutlineEditor& editor) {
  Spread patch_ms;
  Spread piece_ms;
  Spread curve_ms;
  Spread cut_ms;
  const SurfacePatch& patch = editor.local().patch();
  const auto nodes = nodesOf(patch, editor.outline()->outline.curve);
  const auto& clicks = editor.clicks().points;
  for (int i = 0; i < 11; ++i) {
    patch_ms.add(milliseconds([&] {
      static_cast<void>(extractPatch(leg.foot->mesh, patch.center_mm, patch.clear_radius_mm));
    }));
    GrowingPatch local = editor.local();
    piece_ms.add(milliseconds([&] { static_cast<void>(tracePiece(local, clicks[0], clicks[1])); }));
    curve_ms.add(
        milliseconds([&] { static_cast<void>(simpleCurve(patch, nodes, CurveEnds::Joined)); }));
    cut_ms.add(milliseconds([&] { static_cast<void>(cutAlong(patch, {nodes})); }));
  }
  std::printf(
      "    patch of %zu faces cut out %.1f ms (when a point leaves it); one piece %.2f, "
      "judging %.2f, cut %.1f ms; %zu nodes\n",
      patch.faces.size(),
      patch_ms.median(),
      piece_ms.median(),
      curve_ms.median(),
      cut_ms.median(),
      nodes.size());
}

void benchRadius(const Leg& leg, double radius_mm, int count, bool smooth) {
  OutlineEditor editor(leg.foot, leg.index);
  Spread placed;
  for (int i = 0; i < count; ++i) {
    const double a = 2.0 * pi * i / count;
    placed.add(milliseconds([&] {
      editor = appendClick(editor, leg.at(radius_mm * std::cos(a), radius_mm * std::sin(a)));
    }));
  }
  editor = closeOutline(makeSmooth(editor, smooth));
  if (!editor.outline()) {
    std::printf("%s\n", describe(editor.problem()->error).c_str());
    return;
  }
  Spread moved;
  Spread inserted;
  Spread deleted;
  test::Dice dice(5);
  for (int i = 0; i < 60; ++i) {
    const int click = static_cast<int>(dice.uniform() * count);
    const double a = 2.0 * pi * (click + 0.5) / count;
    const double r = radius_mm * dice.uniform(0.95, 1.05);
    const auto middle = leg.at(r * std::cos(a), r * std::sin(a));
    const double b = 2.0 * pi * click / count;
    const auto there = leg.at(r * std::cos(b), r * std::sin(b));
    OutlineEditor next = editor;
    moved.add(milliseconds([&] { next = moveClick(editor, click, there); }));
    inserted.add(milliseconds([&] { next = insertClick(editor, middle); }));
    deleted.add(milliseconds([&] { next = deleteClick(editor, click); }));
  }
  std::printf("%5.0f mm %4d %-9s %7.1f (%5.1f) %7.1f (%5.1f) %7.1f (%5.1f) %7.1f (%5.1f)\n",
              radius_mm,
              count,
              smooth ? "smooth" : "straight",
              placed.median(),
              placed.worst(),
              moved.median(),
              moved.worst(),
              inserted.median(),
              inserted.worst(),
              deleted.median(),
              deleted.worst());
  printParts(leg, editor);
}

/// Tools beside single clicks, around the crater's rim of 9 mm.
void benchTools(const Leg& leg) {
  const OutlineEditor empty(leg.foot, leg.index);
  test::Dice dice(8);
  std::vector<Eigen::Vector3d> stroke;
  for (int i = 0; i < 300; ++i) {
    const double a = 2.0 * pi * i / 300.0;
    const double r = 9.0 + 0.5 * std::sin(5.0 * a) + 0.1 * dice.uniform(-1.0, 1.0);
    stroke.push_back(leg.at(r * std::cos(a), r * std::sin(a)));
  }
  const OutlineEditor ready = closeOutline(appendClick(empty, stroke.front()));
  Spread straight;
  Spread smooth;
  Spread magnetic;
  Spread click;
  Spread dab;
  Spread border;
  PaintedRegion region(leg.foot);
  region.paint(leg.index->nearest(leg.at(0.0, 0.0), 1.0)->point, 4.0);
  for (int i = 0; i < 15; ++i) {
    straight.add(milliseconds([&] { static_cast<void>(drawStroke(ready, stroke)); }));
    smooth.add(
        milliseconds([&] { static_cast<void>(drawStroke(makeSmooth(ready, true), stroke)); }));
    magnetic.add(milliseconds([&] {
      static_cast<void>(drawStroke(makeSmooth(ready, true), stroke, {.click = {.magnetic = true}}));
    }));
    click.add(milliseconds([&] {
      static_cast<void>(bindClick(ready, stroke[static_cast<std::size_t>(i)], {.magnetic = true}));
    }));
    const auto at = leg.index->nearest(leg.at(0.5 * i, 0.0), 1.0)->point;
    dab.add(milliseconds([&] { region.paint(at, 4.0); }));
    border.add(milliseconds([&] { static_cast<void>(borderOf(region)); }));
  }
  std::printf(
      "a stroke of 57 mm: straight %.0f ms, smooth %.0f, smooth and magnetic %.0f; "
      "a magnetic click %.1f; a dab of the brush %.1f, its border %.1f\n",
      straight.median(),
      smooth.median(),
      magnetic.median(),
      click.median(),
      dab.median(),
      border.median());
}

}  // namespace
}  // namespace tarsus

int main() {
  const tarsus::Leg leg;
  std::printf("%zu faces; each edit with area and perimeter, median (worst) of 60, ms\n",
              leg.foot->mesh.faces.size());
  std::printf(
      " radius  clicks line        place           move            insert          delete\n");
  for (const bool smooth : {false, true}) {
    for (const auto& [radius_mm, count] : {std::pair{5.0, 8}, {10.0, 16}, {20.0, 30}}) {
      tarsus::benchRadius(leg, radius_mm, count, smooth);
    }
  }
  tarsus::benchTools(leg);
}
