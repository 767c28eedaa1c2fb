#!/bin/sh
# Plants one violation after another in a temporary tree: each check must find its own.
set -eu
here=$(cd "$(dirname "$0")" && pwd)
tree=$(mktemp -d)
trap 'rm -rf "$tree"' EXIT
failures=0

# write FILE LINE: a file of one line in the tree
write() {
  mkdir -p "$tree/$(dirname "$1")"
  printf '%s\n' "$2" >"$tree/$1"
}

# expect_found CLAIM TEXT: check_tree.sh must fail and its output must hold TEXT
expect_found() {
  if output=$(sh "$here/check_tree.sh" "$tree"); then
    echo "not found: $1"; failures=$((failures + 1))
  elif ! printf '%s\n' "$output" | grep -qF "$2"; then
    echo "found, but not as \"$2\": $1"; printf '%s\n' "$output"; failures=$((failures + 1))
  fi
  rm -r "${tree:?}"/*
}

# plant FILE LINE TEXT: the one-line file must be found as TEXT
plant() {
  write "$1" "$2"
  expect_found "$1: $2" "$3"
}

# Clean trees pass.
write app/cli/main.cpp '#include "reconstruction/pipeline/reconstruct.h"'
write measurement/wound/measure.h '#include "measurement/outline/outline.h"'
write reconstruction/texture/color_map.cpp '#include <opencv2/core.hpp>'
write reconstruction/base/error.h '#include <string>'
write tests/reconstruction/base/error_test.cpp '#include "app/cli/options.h"'
write README.md "$(yes line | head -n 60)"  # the root README is no folder README
if ! sh "$here/check_tree.sh" "$tree"; then echo "a clean tree fails"; failures=$((failures + 1)); fi
rm -r "${tree:?}"/*

# Arrows between the four folders, and into the tests.
plant reconstruction/base/a.cpp '#include "measurement/wound/measure.h"' 'against the arrows'
plant reconstruction/pipeline/a.h '  #  include "ui/window.h"' 'against the arrows'
plant measurement/report/a.cpp '#include "ui/window.h"' 'against the arrows'
plant ui/a.cpp '#include "app/settings.h"' 'against the arrows'
plant app/cli/a.cpp '#include "tests/support/shared_data.h"' 'against the arrows'

# Arrows within reconstruction and measurement, each to its next.
plant reconstruction/base/a.h '#include "reconstruction/scene/mesh.h"' 'against the arrows'
plant reconstruction/scene/a.h '#include "reconstruction/capture/frame_source.h"' 'against the arrows'
plant reconstruction/capture/simulator/a.h '#include "reconstruction/fusion/fusion.h"' 'against the arrows'
plant reconstruction/fusion/a.h '#include "reconstruction/texture/keyframes.h"' 'against the arrows'
plant reconstruction/texture/a.h '#include "reconstruction/pipeline/reconstruct.h"' 'against the arrows'
plant measurement/outline/a.h '#include "measurement/wound/measure.h"' 'against the arrows'
plant measurement/wound/a.h '#include "measurement/report/report.h"' 'against the arrows'

# Includes that say nothing of the folder, and folders that nobody put in order.
plant reconstruction/scene/a.cpp '#include "mesh.h"' 'not written from the repository root'
plant measurement/novelty/a.cpp '#include <string>' 'has no place in the order'

# Heavy libraries in headers.
for library in CGAL/Surface_mesh.h pcl/point_types.h OpenMesh/Core/Mesh.hh ceres/ceres.h \
    vtkActor.h opencv2/core.hpp OpenNI.h embree3/rtcore.h open3d/Open3D.h; do
  plant measurement/wound/a.h "#include <$library>" 'heavy library in a header'
  plant ui/a.h "#include <$library>" 'heavy library in a header'
done

# READMEs and paths. The path is put together here, so that this file holds none itself.
plant reconstruction/base/README.md "$(yes line | head -n 41)" '41 lines, 40 are allowed'
plant scripts/a "data=/ho""me/somebody/scan" 'somebody'

# The list of shared libraries, with an ldd that answers what we plant.
expect_libraries() {
  write bin/ldd "$(printf '#!/bin/sh\necho "%s"' "$2")"
  chmod +x "$tree/bin/ldd"
  verdict=clean
  PATH="$tree/bin:$PATH" sh "$here/check_libraries.sh" program >/dev/null || verdict=found
  if [ "$verdict" != "$1" ]; then echo "$2: $verdict, not $1"; failures=$((failures + 1)); fi
}
expect_libraries clean 'libQt5Gui.so.5 => /usr/lib/libQt5Gui.so.5 (0x1)'
expect_libraries found 'libQt5Widgets.so.5 => /usr/lib/libQt5Widgets.so.5 (0x1)'
expect_libraries found 'libQt6Widgets.so.6 => /usr/lib/libQt6Widgets.so.6 (0x1)'
expect_libraries found 'libvtkCommonCore-9.1.so.1 => /usr/lib/libvtkCommonCore-9.1.so.1 (0x1)'
expect_libraries found 'libopencv_highgui.so.406 => /usr/lib/libopencv_highgui.so.406 (0x1)'
expect_libraries found 'libceres.so.3 => not found'
expect_libraries found 'not a dynamic executable'

[ "$failures" -eq 0 ] || { echo "$failures planted cases went wrong"; exit 1; }
echo "every planted violation was found"
