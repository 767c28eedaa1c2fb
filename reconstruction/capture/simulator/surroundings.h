#pragma once

#include "reconstruction/capture/simulator/intact_foot.h"
#include "reconstruction/scene/mesh.h"

namespace tarsus {

/// The bench that carries the calf, the wall behind it and the floor; foot frame [mm]. The patient
/// lies: the leg is level, the toes point up, the foot reaches over the bench's edge.
[[nodiscard]] TexturedMesh makeSurroundings(const IntactFoot& foot);

}  // namespace tarsus
