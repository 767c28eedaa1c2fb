#pragma once

#include "measurement/records/export/bundle.h"
#include "measurement/records/vault.h"

namespace tarsus {

/// The bundle for research: names, identifiers, dates of birth, authors and free text are gone;
/// every id is a keyed hash; times count from the patient's first visit, which becomes 2000-01-01,
/// and keep their distances; pictures and what the scan says of its camera are left out.
[[nodiscard]] ExportBundle pseudonymised(ExportBundle bundle, const SecretKey& key);

/// A curve's or a tissue map's document with the fields that Tarsus gives meaning to: further ones
/// are free (design.md section 4), and may say who it is.
[[nodiscard]] nlohmann::json withoutFreeFields(const nlohmann::json& document);

}  // namespace tarsus
