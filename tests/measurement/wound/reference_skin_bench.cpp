/// Decides which reference skin is the default: prints, as Markdown, how far each candidate misses
/// the true skin over a wound, on ideal skins and on feet. About ten minutes on one core.
/// Run: tarsus-bench-reference-skin [seeds, 20 unless told]

#include "tests/measurement/wound/foot_skin_bench.h"
#include "tests/measurement/wound/ideal_skin_bench.h"
#include "tests/support/shared_data.h"

#include <cstdio>
#include <cstdlib>

int main(int argc, char** argv) {
  const int seeds = argc > 1 ? std::atoi(argv[1]) : 20;
  if (seeds < 2) {
    std::fprintf(stderr, "Give a number of seeds of 2 or more, or none for 20.\n");
    return 2;
  }
  tarsus::test::benchIdealSkins(seeds);
  tarsus::test::benchFeet(tarsus::sharedData("foot"), seeds);
}
