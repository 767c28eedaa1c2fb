#include "reconstruction/base/parallel.h"
#include "reconstruction/capture/scan_folder.h"
#include "reconstruction/capture/simulator/scan_fault.h"
#include "reconstruction/capture/simulator/simulator.h"
#include "reconstruction/capture/simulator/truth_file.h"

#include <array>
#include <cstdio>
#include <utility>
#include <vector>

namespace tarsus {
namespace {

constexpr std::array<std::pair<FootCase, std::string_view>, 4> kFeet = {
    {{FootCase::Forefoot, "forefoot"},
     {FootCase::Heel, "heel"},
     {FootCase::Lateral, "lateral"},
     {FootCase::Two, "two"}}};
constexpr std::array<std::pair<CameraPath, std::string_view>, 3> kPaths = {
    {{CameraPath::Rig, "rig"}, {CameraPath::Loop, "loop"}, {CameraPath::Quick, "quick"}}};
constexpr std::array<std::pair<CameraLayout, std::string_view>, 2> kLayouts = {
    {{CameraLayout::Aligned, "aligned"}, {CameraLayout::Offset, "offset"}}};

constexpr std::array<std::pair<ScanFault, std::string_view>, 9> kFaults = {
    {{ScanFault::None, "none"},
     {ScanFault::Black, "black"},
     {ScanFault::Jump, "jump"},
     {ScanFault::Holes, "holes"},
     {ScanFault::Dropped, "dropped"},
     {ScanFault::Mirrored, "mirrored"},
     {ScanFault::Rest, "rest"},
     {ScanFault::Blocked, "blocked"},
     {ScanFault::Unit, "unit"}}};

constexpr std::array<std::pair<HealingCourse, std::string_view>, 4> kCourses = {
    {{HealingCourse::Shrinking, "shrinking"},
     {HealingCourse::Deepening, "deepening"},
     {HealingCourse::Filling, "filling"},
     {HealingCourse::Splitting, "splitting"}}};

template <typename Table, typename Value>
std::string_view nameIn(const Table& table, Value value) {
  for (const auto& [entry, name] : table) {
    if (entry == value) {
      return name;
    }
  }
  return {};
}

template <typename Value, std::size_t kCount>
std::optional<Value> valueIn(const std::array<std::pair<Value, std::string_view>, kCount>& table,
                             std::string_view name) {
  for (const auto& [value, entry] : table) {
    if (entry == name) {
      return value;
    }
  }
  return std::nullopt;
}

/// Encoding is the slow part, so several frames are written at a time.
Expected<void> writeBatch(ScanFolderWriter& writer, const std::vector<RgbdFrame>& batch) {
  std::vector<Expected<void>> done(batch.size());
  parallelFor(static_cast<int>(batch.size()), [&](int i) {
    const auto k = static_cast<std::size_t>(i);
    done[k] = writer.write(batch[k]);
  });
  for (Expected<void>& result : done) {
    if (!result) {
      return result;
    }
  }
  return {};
}

Expected<void> writeFrames(ScanFolderWriter& writer, FrameSource& source, const Job& job) {
  constexpr std::size_t kBatch = 8;
  std::vector<RgbdFrame> batch;
  const int total = source.frameCount().value_or(1);
  for (;;) {
    if (job.stopped()) {
      return fail(ErrorCode::Cancelled);
    }
    auto frame = source.next();
    if (!frame) {
      return tl::unexpected(frame.error());
    }
    const bool at_end = !frame->has_value();
    if (!at_end) {
      job.report("simulate", static_cast<double>((*frame)->index + 1) / total);
      batch.push_back(std::move(**frame));
    }
    if (at_end || batch.size() == kBatch) {
      if (auto ok = writeBatch(writer, batch); !ok) {
        return ok;
      }
      batch.clear();
    }
    if (at_end) {
      return {};
    }
  }
}

/// True poses of the frames that the scan holds.
Trajectory posesOf(const Trajectory& all, ScanFault fault) {
  if (fault != ScanFault::Dropped) {
    return all;
  }
  Trajectory kept;
  for (const FramePose& pose : all) {
    if (!strikes(fault, pose.frame_index, static_cast<int>(all.size()))) {
      kept.push_back(pose);
      kept.back().frame_index = static_cast<int>(kept.size()) - 1;
    }
  }
  return kept;
}

}  // namespace

std::string_view nameOf(FootCase foot) { return nameIn(kFeet, foot); }
std::string_view nameOf(CameraPath path) { return nameIn(kPaths, path); }
std::string_view nameOf(CameraLayout layout) { return nameIn(kLayouts, layout); }
std::string_view nameOf(ScanFault fault) { return nameIn(kFaults, fault); }
std::string_view nameOf(HealingCourse course) { return nameIn(kCourses, course); }
std::optional<HealingCourse> healingCourseNamed(std::string_view name) {
  return valueIn(kCourses, name);
}
std::optional<FootCase> footCaseNamed(std::string_view name) { return valueIn(kFeet, name); }
std::optional<CameraPath> cameraPathNamed(std::string_view name) { return valueIn(kPaths, name); }
std::optional<CameraLayout> cameraLayoutNamed(std::string_view name) {
  return valueIn(kLayouts, name);
}
std::optional<ScanFault> scanFaultNamed(std::string_view name) { return valueIn(kFaults, name); }

Expected<void> simulateScan(const std::filesystem::path& folder,
                            const SimulatorOptions& options,
                            const Job& job) {
  job.report("foot", 0.0);
  const auto scene = buildScene(options);
  if (!scene) {
    return tl::unexpected(scene.error());
  }
  return writeSimulatedScan(folder, *scene, options, job);
}

Expected<void> writeSimulatedScan(const std::filesystem::path& folder,
                                  const std::shared_ptr<const SimulatedScene>& scene,
                                  const SimulatorOptions& options,
                                  const Job& job) {
  const std::unique_ptr<FrameSource> source = openSimulator(scene, options);
  auto writer = ScanFolderWriter::create(folder, source->camera());
  if (!writer) {
    return tl::unexpected(writer.error());
  }
  if (auto ok = writeTruth(folder / "truth", *scene, options); !ok) {
    return ok;
  }
  if (auto ok = writeFrames(*writer, *source, job); !ok) {
    return ok;
  }
  return writer->finish(posesOf(scene->trajectory, options.fault));
}

Expected<std::string> simulatedWoundTable(const std::filesystem::path& mesh) {
  std::string table =
      "| foot | site | opening area mm2 | volume mm3 | V/A mm | max depth mm | length x width, "
      "clock mm | length x width, chords mm | camera, path |\n"
      "|---|---|---|---|---|---|---|---|---|\n";
  for (const auto& [foot, name] : kFeet) {
    SimulatorOptions options;
    options.foot = foot;
    options.frames = 1;
    options.mesh = mesh;
    const auto scene = buildScene(options);
    if (!scene) {
      return tl::unexpected(scene.error());
    }
    for (const WoundTruth& w : (*scene)->wounds) {
      std::array<char, 400> line{};
      std::snprintf(line.data(),
                    line.size(),
                    "| %s | %s | %.1f | %.1f | %.2f | %.2f | %.1f x %.1f | %.1f x %.1f | %s, %s "
                    "(default; any) |\n",
                    std::string(name).c_str(),
                    w.site.c_str(),
                    w.opening_area_mm2,
                    w.volume_mm3,
                    w.mean_depth_mm,
                    w.max_depth_mm,
                    w.length_clock_mm,
                    w.width_clock_mm,
                    w.length_mm,
                    w.width_mm,
                    std::string(nameOf(options.layout)).c_str(),
                    std::string(nameOf(options.path)).c_str());
      table += line.data();
    }
  }
  return table;
}

}  // namespace tarsus
