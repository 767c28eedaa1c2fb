#pragma once

namespace tarsus::test {

/// Prints the error of the volume under each candidate in per cent of a bowl wound's volume, mean
/// +- standard deviation over the seeds: one table for each thing that is varied.
void benchIdealSkins(int seeds);

}  // namespace tarsus::test
