#include "app/cli/command.h"
#include "app/cli/print_report.h"
#include "app/cli/wound_arguments.h"

#include <CLI/CLI.hpp>

#include <iostream>
#include <memory>

namespace tarsus {

void addReport(CLI::App& app, Command& command) {
  struct Arguments {
    WoundArguments wound;
    std::filesystem::path pdf;
    std::string title;
    std::string form = "full";
    std::string paper = "a4";
  };
  auto arguments = std::make_shared<Arguments>();
  CLI::App* sub = addCommand(app, command, "report", "Measure one wound and print it as PDF");
  addWoundOptions(*sub, arguments->wound);
  sub->add_option("OUT", arguments->pdf, "The PDF to write")->required()->type_name("OUT.pdf");
  sub->add_option("--title", arguments->title, "Who, which wound, which scan; at most 200 letters")
      ->type_name("TEXT")
      ->check([](const std::string& title) {
        return title.size() <= 200 ? std::string() : std::string("longer than 200 letters");
      });
  sub->add_option("--form", arguments->form, "The whole report, or one page for the bedside")
      ->check(CLI::IsMember({"full", "bedside"}))
      ->capture_default_str();
  sub->add_option("--paper", arguments->paper)
      ->check(CLI::IsMember({"a4", "letter"}))
      ->capture_default_str();
  sub->callback([&command, arguments] {
    command.run = [&command, arguments](const Job& /*job*/) -> Expected<nlohmann::json> {
      auto measured = measureFiles(arguments->wound);
      if (!measured) {
        return tl::unexpected(measured.error());
      }
      const std::string title = arguments->title.empty()
                                    ? "Model " + arguments->wound.model.filename().string()
                                    : arguments->title;
      if (auto printed = printReport(
              arguments->pdf,
              *measured,
              arguments->wound.model,
              {.title = title,
               .form = arguments->form == "bedside" ? ReportForm::Bedside : ReportForm::Full,
               .paper = arguments->paper == "letter" ? ReportPaper::Letter : ReportPaper::A4});
          !printed) {
        return tl::unexpected(printed.error());
      }
      if (!command.quiet && command.json_file != "-") {
        std::cout << "Wrote " << arguments->pdf.string() << '\n';
      }
      return measurementJson(*measured);
    };
  });
}

}  // namespace tarsus
