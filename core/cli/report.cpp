// marey report: runs an experiment document.
#include "report/report.h"

#include <memory>

#include "families.h"

#include "cli/command.h"
#include "cli/experiment_command.h"
#include "cli/readers.h"
#include "report/experiment_report.h"

namespace marey::cli {

void runReport(const Experiment& experiment, const std::string& out, bool pdf,
               const Context& context) {
  Progress progress = context.progress("report");
  Progress running = progress.part(0.0, 0.6), counting = progress.part(0.6, 0.75),
           writing = progress.part(0.75, 1.0);
  const ExperimentResult result =
      runExperiment(experiment, modelFamilies(), running, *context.ranks);
  if (!context.ranks->first()) return;
  const report::ReportData data = report::reportOf(result, context.commandLine, counting);
  const report::ReportFiles files = report::writeReport(data, out, writing, {.pdf = pdf});
  progress.report(1.0, "written");
  Json tables = Json::array(), figures = Json::array();
  for (const auto& file : files.tables) tables.push_back(file.string());
  for (const auto& file : files.figures) figures.push_back(file.string());
  Json leftOut = Json::array();
  for (const LeftOut& one : result.leftOut)
    leftOut.push_back({{"name", one.what}, {"why", one.why}});
  std::string text = files.html.string();
  for (const LeftOut& one : result.leftOut)
    text += fmt::format("\nleft out: {}: {}", one.what, one.why);
  text += files.pdf.empty() ? "\nno PDF: " + files.pdfNote : "\n" + files.pdf.string();
  if (const std::string missing = report::missingText(result); !missing.empty())
    text += "\n" + missing;
  Json json = {{"report", files.html.string()},
               {"pdf", files.pdf.string()},
               {"tables", tables},
               {"figures", figures},
               {"left_out", leftOut},
               {"experiment_hash", result.hash}};
  result.inputs.addTo(json);
  tell(context, result.inputs);
  context.print(json, text);
}

namespace {
struct Options {
  std::string experiment, out;
  bool pdf = true;
};
}  // namespace

void addReportCommand(CLI::App& app, Context& context) {
  auto o = std::make_shared<Options>();
  auto* command = addCommand(
      app, context, "report", "Run an experiment document and write its report",
      "marey report experiment.json --out report",
      [o, &context] { runReport(readExperiment(o->experiment), o->out, o->pdf, context); },
      Processes::Many);
  command->add_option("EXPERIMENT", o->experiment, "Experiment document (JSON)")->required();
  command->add_option("--out", o->out, "Folder to write to")->required();
  command->add_flag("--pdf,!--no-pdf", o->pdf,
                    "Also write report.pdf (default on; needs the program weasyprint)");
}

}  // namespace marey::cli
