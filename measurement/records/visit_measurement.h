#pragma once

#include "measurement/records/visits.h"
#include "measurement/wound/wound_files.h"
#include "reconstruction/base/error.h"

#include <string>
#include <string_view>
#include <vector>

namespace tarsus {

/// The roles of a visit's files from which its numbers come.
inline constexpr std::string_view kModelRole = "model";
inline constexpr std::string_view kOutlineRole = "outline";
inline constexpr std::string_view kSkinCurveRole = "skin_curve";
inline constexpr std::string_view kTissueRole = "tissue";
inline constexpr std::string_view kReconstructionRole = "reconstruction";

/// Measures a wound and keeps all that its numbers come from with the visit: the files (those of an
/// earlier measurement give way to them; its own version of the visit keeps them), and
/// reconstruction.json where it lies beside the model. An edit of a draft, else an amendment.
/// @param version  of the program
/// @errors those of measureFiles, editVisit and FileStore::put
[[nodiscard]] Expected<Measurement> measureVisit(Store& store,
                                                 std::string_view visit_id,
                                                 std::int64_t base_revision,
                                                 const WoundFiles& files,
                                                 std::string_view version,
                                                 std::string_view reason = {});

/// A visit's files, decrypted into a folder; what the visit has not is left empty.
/// @errors RecordMissing (no measurement), FileMissing, StoreDamaged, FileUnwritable, DiskFull
[[nodiscard]] Expected<WoundFiles> visitFiles(Store& store,
                                              const Visit& visit,
                                              const std::filesystem::path& folder);

/// One number that came out otherwise.
struct Difference {
  std::string key;  ///< of measurement.json, "/" between levels
  nlohmann::json stored;
  nlohmann::json now;
};

struct Recomputation {
  std::string stored_version;
  std::string version;
  std::string stored_method;
  std::string method;
  std::string stored_model_sha256;
  std::string model_sha256;
  std::vector<Difference> differences;  ///< empty: the same numbers to the last bit
};

/// Measures a visit once more from what is kept of it, and compares each number bit by bit.
/// @param folder  empty, for the decrypted files; what is written there stays
/// @errors those of visitFiles and measureFiles
[[nodiscard]] Expected<Recomputation> recomputeVisit(Store& store,
                                                     std::string_view visit_id,
                                                     const std::filesystem::path& folder,
                                                     std::string_view version);

}  // namespace tarsus
