#include <fmt/format.h>

#include "base/atomic_file.h"
#include "base/error.h"
#include "report/figures.h"
#include "report/page.h"
#include "report/pdf.h"
#include "report/report.h"
#include "report/tables.h"

namespace marey::report {

namespace fs = std::filesystem;

namespace {
/// Writes into the staged folder and notes where files will be in the end.
class Output {
 public:
  Output(fs::path staging, fs::path target)
      : m_staging(std::move(staging)), m_target(std::move(target)) {}

  fs::path write(const fs::path& name, std::string_view content) const {
    writeFileAtomically(m_staging / name, content);
    return m_target / name;
  }
  fs::path staged(const fs::path& name) const { return m_staging / name; }
  fs::path target(const fs::path& name) const { return m_target / name; }

 private:
  fs::path m_staging, m_target;
};

render::Recipe recipeOf(const ReportData& data, const std::string& item) {
  render::Recipe recipe = data.recipe;
  recipe.emplace_back("item", item);
  return recipe;
}

PageFigure writeFigure(const Figure& figure, const ReportData& data, const ReportOptions& options,
                       const Output& output, ReportFiles& files) {
  const render::Recipe recipe = recipeOf(data, figure.id);
  const fs::path name = fs::path("figures") / figure.id;
  const std::string description = figure.title + ". " + figure.caption;
  if (figure.scene) {
    const render::Image image =
        render::drawEnd(*figure.scene, options.sceneWidth, options.sceneHeight);
    const std::string png = render::encodePng(image, recipe);
    files.figures.push_back(output.write(
        name.string() + ".svg", sceneSvg(png, image.width, image.height, description, recipe)));
    files.figures.push_back(output.write(name.string() + ".png", png));
    return {&figure, imageMarkup(png, description)};
  }
  constexpr double pngScale = 2.0;
  const std::string svg = render::drawSvg(*figure.chart, figure.size, recipe, figure.id);
  files.figures.push_back(output.write(name.string() + ".svg", svg));
  files.figures.push_back(output.write(
      name.string() + ".png",
      render::encodePng(render::drawImage(*figure.chart, figure.size, pngScale), recipe)));
  return {&figure, svgMarkup(svg, description)};
}

void writeTable(const Table& table, const ReportData& data, const Output& output,
                ReportFiles& files) {
  const render::Recipe recipe = recipeOf(data, table.id);
  const std::string name = (fs::path("tables") / table.id).string();
  files.tables.push_back(output.write(name + ".csv", tableCsv(table)));
  files.tables.push_back(
      output.write(name + ".csv.json", tableSidecar(table, recipe).dump(2) + "\n"));
  files.tables.push_back(output.write(name + ".json", tableJson(table, recipe).dump(2) + "\n"));
}

void addPdf(const Output& output, ReportFiles& files) {
  const PdfResult result = writePdf(output.staged("report.html"), output.staged("report.pdf"));
  if (result.written) files.pdf = output.target("report.pdf");
  files.pdfNote = result.note;
}
}  // namespace

ReportFiles writeReport(const ReportData& data, const fs::path& folder, Progress& progress,
                        const ReportOptions& options) {
  validate(data);
  StagedFolder staged(folder);
  const Output output(staged.path(), folder);
  ReportFiles files;
  const std::vector<Figure> figures = figuresOf(data);
  std::vector<PageFigure> pageFigures;
  for (size_t i = 0; i < figures.size(); ++i) {
    progress.throwIfCancelled();
    progress.report(0.8 * static_cast<double>(i) / static_cast<double>(figures.size()),
                    figures[i].title);
    pageFigures.push_back(writeFigure(figures[i], data, options, output, files));
  }
  for (const Table& table : data.tables) writeTable(table, data, output, files);
  files.html = output.write("report.html", pageHtml(data, pageFigures));
  progress.throwIfCancelled();
  progress.report(0.8, "writing the PDF");
  if (options.pdf) addPdf(output, files);
  staged.commit();
  progress.report(1.0, "report written");
  return files;
}

}  // namespace marey::report
