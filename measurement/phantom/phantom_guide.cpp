#include "measurement/phantom/phantom_guide.h"

#include <array>
#include <cstdio>

namespace tarsus {
namespace {

constexpr const char* kBeforeTable =
    R"(Phantoms: wounds of exactly known size, to see whether a camera measures right today
====================================================================================
Each NAME.stl is a body to print (millimetres), NAME.phantom.json says what its wounds measure
exactly and where they lie. foot_block carries all four surfaces and suits a daily check; the plates
carry one each, and their number of bumps tells them apart.

Print
  Flat side down, 100 % size, no support, layers of 0.12 mm or finer, 4 walls, 15 % infill or more.
  Nothing on top but the print itself: no sanding of the wounds, no thick paint.
  Colour: light and matt, one colour (white, light grey, skin). Glossy plastic gets a thin coat of
  matt spray. No speckle or texture is needed: only the shape counts.

Check the print with a caliper before it is used; it must be right to 0.2 %, or to 0.1 mm:
)";

constexpr const char* kAfterTable =
    R"(  If it is not: correct the printer's scale by the quotient and print again. Heat bends plastic:
  keep the phantom out of the sun, and check it again every few months.

Scan
  Lay the phantom on a table, wounds up, nothing else within 10 cm; things farther away help the
  camera to know where it is. Let it warm up as for a patient. Scan at 30 to 45 cm for 20 s from all
  sides, as a foot is scanned.

Verify
  tarsus-cli verify SCAN foot_block.phantom.json
  No mark is set by hand: the phantom is found by its shape. The command prints measured and true
  values, the error of scale, and whether this camera is within the limits. Each result is added to
  foot_block.chart.jsonl (a control chart: --chart FILE keeps it elsewhere), so that a slow drift is
  seen before it matters. Keep NAME.stl and NAME.phantom.json together as they were when the
  phantom was printed.

Research software. Not a medical device; not cleared by any authority; must not be the sole basis of
a clinical decision.
)";

}  // namespace

std::string phantomGuide(const std::vector<PhantomDesign>& designs) {
  std::string text = kBeforeTable;
  for (const PhantomDesign& design : designs) {
    text += "  " + design.name + "\n";
    for (const ControlDistance& distance : design.control_distances) {
      std::array<char, 160> line{};
      std::snprintf(line.data(),
                    line.size(),
                    "    %-55s %7.2f +- %.2f mm\n",
                    distance.what.c_str(),
                    distance.mm,
                    controlTolerance_mm(distance.mm));
      text += line.data();
    }
  }
  return text + kAfterTable;
}

}  // namespace tarsus
