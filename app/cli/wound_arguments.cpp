#include "app/cli/wound_arguments.h"

#include "app/version.h"

#include <CLI/CLI.hpp>

#include <utility>

namespace tarsus {

void addWoundOptions(CLI::App& sub, WoundArguments& arguments) {
  sub.add_option("MODEL", arguments.model, "model.ply, mm")->required();
  sub.add_option("--outline", arguments.outline, "Wound outline (JSON, scan frame, mm)")
      ->required()
      ->type_name("FILE");
  sub.add_option("--skin-curve",
                 arguments.skin_curve,
                 "Where healthy skin begins (same format); default 2 mm outside the outline")
      ->type_name("FILE");
  sub.add_option("--tissue", arguments.tissue, "Painted tissue of this model (see tissue)")
      ->type_name("FILE");
  auto* heel = sub.add_option("--heel", arguments.heel_mm, "Heel landmark, for clock directions")
                   ->delimiter(',')
                   ->expected(3)
                   ->type_name("X,Y,Z");
  auto* toe = sub.add_option("--toe", arguments.toe_mm, "Toe landmark")
                  ->delimiter(',')
                  ->expected(3)
                  ->type_name("X,Y,Z")
                  ->needs(heel);
  heel->needs(toe);
}

WoundFiles filesOf(const WoundArguments& arguments) {
  WoundFiles files{.model = arguments.model,
                   .outline = arguments.outline,
                   .skin_curve = arguments.skin_curve,
                   .tissue = arguments.tissue,
                   .landmarks = std::nullopt};
  if (arguments.heel_mm.size() == 3 && arguments.toe_mm.size() == 3) {
    files.landmarks = Landmarks{.heel_mm = Eigen::Vector3d(arguments.heel_mm.data()),
                                .toe_mm = Eigen::Vector3d(arguments.toe_mm.data())};
  }
  return files;
}

Expected<MeasuredModel> measureFiles(const WoundArguments& arguments) {
  return measureFiles(filesOf(arguments));
}

nlohmann::json measurementJson(const MeasuredModel& measured) {
  return measurementJson(measured, TARSUS_VERSION);
}

}  // namespace tarsus
