#pragma once

#include "reconstruction/base/job.h"
#include "reconstruction/capture/frame_source.h"
#include "reconstruction/scene/mesh.h"

#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace tarsus {

/// Which foot, by its ulcers; the table in capture/simulator/README.md gives their sizes.
enum class FootCase { Forefoot, Heel, Lateral, Two };
enum class CameraPath { Rig, Loop, Quick };
enum class CameraLayout { Aligned, Offset };
/// What goes wrong during the scan; the table in capture/simulator/README.md says what each does.
/// The scene and its truth stay right whatever the camera does.
enum class ScanFault { None, Black, Jump, Holes, Dropped, Mirrored, Rest, Blocked, Unit };

/// What the bed of a simulated ulcer is made of at one place.
enum class BedTissue : std::uint8_t { None, Granulation, Slough, Necrosis, Epithelium };

/// The words of the command line.
[[nodiscard]] std::string_view nameOf(FootCase foot);
[[nodiscard]] std::string_view nameOf(CameraPath path);
[[nodiscard]] std::string_view nameOf(CameraLayout layout);
[[nodiscard]] std::string_view nameOf(ScanFault fault);
[[nodiscard]] std::string_view nameOf(BedTissue tissue);
[[nodiscard]] std::optional<FootCase> footCaseNamed(std::string_view name);
[[nodiscard]] std::optional<CameraPath> cameraPathNamed(std::string_view name);
[[nodiscard]] std::optional<CameraLayout> cameraLayoutNamed(std::string_view name);
[[nodiscard]] std::optional<ScanFault> scanFaultNamed(std::string_view name);

struct SimulatorOptions {
  FootCase foot = FootCase::Forefoot;
  CameraPath path = CameraPath::Rig;
  CameraLayout layout = CameraLayout::Aligned;
  ScanFault fault = ScanFault::None;
  int frames = 600;  ///< over the same 20 s motion: fewer frames step further
  std::uint64_t seed = 1;
  double noise = 1.0;          ///< 0: exact depth and colour; 1: SR300 class
  double jitter_mm = 0.0;      ///< hand shake added to the rig's motion, standard deviation
  std::filesystem::path mesh;  ///< a closed foot mesh (OBJ, metres or mm) instead of our own
  /// Of a later visit of the same foot: the ulcers' openings and depths against the first visit,
  /// one ulcer healed across into two, and how foot, toes, camera and light differ (visit.h; 0: not
  /// at all). A foreign foot's toes do not bend.
  double area_factor = 1.0;
  double depth_factor = 1.0;
  bool split = false;
  std::uint64_t posed = 0;
  /// Instead of a foot: an object as it is (STL, PLY or OBJ, mm, z up from its base), on a table.
  /// It has no wounds that the simulator knows of.
  std::filesystem::path object;
};

/// What a simulated ulcer really measures, from the dense mesh; same definitions and names as
/// measurement.json (clinical.md section 2).
struct WoundTruth {
  std::string site;
  double opening_area_mm2 = 0.0;
  double bed_area_mm2 = 0.0;
  double projected_area_mm2 = 0.0;
  double perimeter_mm = 0.0;
  double volume_mm3 = 0.0;
  double mean_depth_mm = 0.0;
  double max_depth_mm = 0.0;
  double p99_depth_mm = 0.0;  ///< area-weighted over the bed
  double length_mm = 0.0;
  double width_mm = 0.0;
  double length_clock_mm = 0.0;
  double width_clock_mm = 0.0;
  double opening_area_second_way_mm2 = 0.0;  ///< by ray grid; must agree within 0.5 %
  double volume_second_way_mm3 = 0.0;
  std::map<std::string, double> tissue_fraction;  ///< of the bed, by name; sums to 1
  std::vector<Eigen::Vector3d> outline_mm;        ///< C, dense closed polyline on the true surface
  std::vector<Eigen::Vector3d> skin_curve_mm;     ///< K, 2 mm outside C along the surface
  Eigen::Vector3d center_mm = Eigen::Vector3d::Zero();
};

/// A foot, its support and background, before any camera; scan frame (first camera = identity).
struct SimulatedScene {
  TexturedMesh foot;  ///< with the ulcers; what a perfect scan would give
  TriangleMesh
      intact_foot;  ///< same faces and vertex order, ulcers filled: the true reference skin
  std::vector<BedTissue> tissue;  ///< #V of foot: what the ulcers' beds are made of; None on skin
  TexturedMesh surroundings;
  std::vector<WoundTruth> wounds;
  Eigen::Vector3d heel_mm = Eigen::Vector3d::Zero();  ///< most posterior plantar point
  Eigen::Vector3d toe_mm = Eigen::Vector3d::Zero();   ///< tip of the second toe
  /// True poses of all frames, first = identity; with the steps of ScanFault::Jump, without motion
  /// for Rest, and also of the frames that Dropped takes away.
  Trajectory trajectory;
  RigidTransform scan_from_foot = RigidTransform::Identity();  ///< what visits have in common [mm]
};

/// How an ulcer goes on from one visit to the next.
enum class HealingCourse {
  Shrinking,  ///< opening and depth fall, as when it heals
  Deepening,  ///< the opening stays, the bed sinks
  Filling,    ///< the bed rises, the opening hardly falls
  Splitting,  ///< shrinks, and is healed across from the sixth week on
};
[[nodiscard]] std::string_view nameOf(HealingCourse course);
[[nodiscard]] std::optional<HealingCourse> healingCourseNamed(std::string_view name);
/// The same scan, so many weeks later; each week posed otherwise.
[[nodiscard]] SimulatorOptions weeksLater(SimulatorOptions first, HealingCourse course, int weeks);

/// @errors FileMissing, MeshInvalid (for options.mesh and options.object), BadOption
[[nodiscard]] Expected<std::shared_ptr<const SimulatedScene>> buildScene(
    const SimulatorOptions& options);

/// The scan as a camera: renders on demand, so that it can serve as a live one. Every fault shows
/// here as it does in a folder.
[[nodiscard]] std::unique_ptr<FrameSource> openSimulator(
    std::shared_ptr<const SimulatedScene> scene, const SimulatorOptions& options);

/// Writes the scan folder and truth/: mesh.ply, intact.ply, outline_N.json, skin_N.json and
/// truth.json (per wound the keys of measurement.json). groundtruth.txt: poses of the frames there.
/// @errors those of buildScene, FileUnwritable, DiskFull, Cancelled
[[nodiscard]] Expected<void> simulateScan(const std::filesystem::path& folder,
                                          const SimulatorOptions& options,
                                          const Job& job);

/// The same for a scene built already with these options.
[[nodiscard]] Expected<void> writeSimulatedScan(const std::filesystem::path& folder,
                                                const std::shared_ptr<const SimulatedScene>& scene,
                                                const SimulatorOptions& options,
                                                const Job& job);

/// What every simulated foot measures, as a Markdown table (README.md keeps its last print).
/// @errors those of buildScene
[[nodiscard]] Expected<std::string> simulatedWoundTable(const std::filesystem::path& mesh = {});

}  // namespace tarsus
