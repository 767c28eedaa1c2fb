#pragma once

#include "measurement/records/export/bundle.h"
#include "measurement/records/export/export.h"

namespace tarsus {

/// The files of one visit: the model as PLY, STL and OBJ, curves and pictures. A pseudonymised
/// model is written anew, without the comments that name its scan.
/// @param visit  as it is kept: what belongs to it is found by its files
/// @errors those of FileStore::get and readPly, FileUnwritable, DiskFull
[[nodiscard]] Expected<void> writeVisitFiles(Store& store,
                                             const Visit& visit,
                                             const std::filesystem::path& folder,
                                             const ExportOptions& options);

}  // namespace tarsus
