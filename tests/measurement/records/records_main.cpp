#include "tests/measurement/records/records_main.h"

#include <QCoreApplication>

#include <gtest/gtest.h>

namespace tarsus {
namespace {

ChildMain& childMain() {
  static ChildMain child = nullptr;
  return child;
}

}  // namespace

int registerChild(ChildMain child) {
  childMain() = child;
  return 0;
}

}  // namespace tarsus

int main(int argc, char** argv) {
  const QCoreApplication application(argc, argv);  // Qt's database drivers ask for one
  const std::vector<std::string> arguments(argv + 1, argv + argc);
  if (!arguments.empty() && arguments.front() == "--child") {
    return tarsus::childMain()({arguments.begin() + 1, arguments.end()});
  }
  testing::InitGoogleTest(&argc, argv);
  return RUN_ALL_TESTS();
}
