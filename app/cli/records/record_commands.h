#pragma once

#include "app/cli/command.h"

namespace tarsus {

void addStoreCommands(CLI::App& app,
                      Command& command);            ///< store, user, audit, backup, restore, export
void addPatients(CLI::App& app, Command& command);  ///< patient
void addWounds(CLI::App& app, Command& command);    ///< wound
void addVisits(CLI::App& app, Command& command);    ///< visit, recompute

}  // namespace tarsus
