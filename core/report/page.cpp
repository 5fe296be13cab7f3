#include "report/page.h"

#include <kainjow/mustache.hpp>

#include "render/base/image.h"
#include "report/resources.h"
#include "report/tables.h"

namespace marey::report {

using kainjow::mustache::data;
using render::escapeXml;

namespace {
struct SectionText {
  Section section;
  const char* id;
  const char* title;
  const char* text;
};

constexpr SectionText sectionTexts[] = {
    {Section::Summary, "summary", "Summary", ""},
    {Section::Motion, "motion", "Motion over each other",
     "Every system on the same paths, many moments on one picture. Natural motion is near-black; "
     "samples are see-through in the colour of their system."},
    {Section::Likelihood, "likelihood", "Log-likelihood",
     "How expected each frame is to the model. Values of different models compare only where "
     "they are about the same features in the same units."},
    {Section::Footsteps, "footsteps", "Footsteps",
     "Feet tell what likelihood does not: whether they are planted, for how long, and how evenly."},
    {Section::Distributions, "distributions", "Joint distributions",
     "Whether each joint moves within the natural range, and fills it."},
    {Section::Statistics, "statistics", "Statistics",
     "Each number with the value of natural motion beside it, and the noise floor: what natural "
     "motion differs from natural motion. Differences below the floor say nothing."},
};

data object() {
  return data(data::type::object);
}
data list() {
  return data(data::type::list);
}

data systemsData(const ReportData& report) {
  data systems = list();
  for (const ReportSystem& system : report.systems) {
    data item = object();
    item.set("name", system.name);
    item.set("colour", render::hexOf(systemColour(system)));
    systems << item;
  }
  return systems;
}

data paragraphs(const std::string& text) {
  data result = list();
  size_t begin = 0;
  while (begin < text.size()) {
    const size_t end = std::min(text.find("\n\n", begin), text.size());
    result << data("text", data(text.substr(begin, end - begin)));
    begin = end + 2;
  }
  return result;
}

data tableData(const Table& table, int number) {
  data item = object();
  item.set("label", fmt::format("Table {}", number));
  item.set("title", table.title);
  item.set("caption", table.caption);
  item.set("id", "table-" + table.id);
  item.set("markup", tableHtml(table));
  data definitions = list();
  bool any = false;
  for (const Column& c : table.columns) {
    if (c.note.empty()) continue;
    data definition = object();
    definition.set("name", c.name);
    definition.set("note", c.note);
    definitions << definition;
    any = true;
  }
  if (any) item.set("definitions", data("items", definitions));
  return item;
}

data figureData(const PageFigure& figure, int number) {
  data item = object();
  item.set("label", fmt::format("Figure {}", number));
  item.set("title", figure.figure->title);
  item.set("caption", figure.figure->caption);
  item.set("id", "figure-" + figure.figure->id);
  item.set("markup", figure.markup);
  return item;
}

/// Sections that have content, with figures and tables numbered through the page.
data sectionsData(const ReportData& report, const std::vector<PageFigure>& figures) {
  data sections = list();
  int figureNumber = 0, tableNumber = 0, sectionNumber = 0;
  for (const SectionText& text : sectionTexts) {
    data shownFigures = list(), shownTables = list();
    for (const Table& table : report.tables) {
      if (table.section == text.section) shownTables << tableData(table, ++tableNumber);
    }
    for (const PageFigure& figure : figures) {
      if (figure.figure->section == text.section)
        shownFigures << figureData(figure, ++figureNumber);
    }
    if (shownFigures.is_empty_list() && shownTables.is_empty_list()) continue;
    data section = object();
    section.set("number", std::to_string(++sectionNumber));
    section.set("id", text.id);
    section.set("title", text.title);
    if (*text.text != '\0') section.set("text", text.text);
    section.set("figures", shownFigures);
    section.set("tables", shownTables);
    sections << section;
  }
  return sections;
}

data notesData(const ReportData& report) {
  data notes = list();
  for (const Note& note : report.notes) {
    data item = object();
    item.set("title", note.title);
    item.set("paragraphs", paragraphs(note.text));
    notes << item;
  }
  return notes;
}

data recipeData(const ReportData& report) {
  data entries = list();
  for (const auto& [key, value] : report.recipe) {
    data item = object();
    item.set("key", key);
    item.set("value", value);
    entries << item;
  }
  return entries;
}
}  // namespace

std::string imageMarkup(const std::string& png, const std::string& description) {
  return fmt::format("<img alt=\"{}\" src=\"data:image/png;base64,{}\">", escapeXml(description),
                     render::base64(png));
}

std::string sceneSvg(const std::string& png, int width, int height, const std::string& description,
                     const render::Recipe& recipe) {
  return fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0}\" height=\"{1}\" "
      "viewBox=\"0 0 {0} {1}\">\n<title>{2}</title>\n<metadata>{3}</metadata>\n"
      "<image width=\"{0}\" height=\"{1}\" href=\"data:image/png;base64,{4}\"/>\n</svg>\n",
      width, height, escapeXml(description), escapeXml(render::recipeText(recipe)),
      render::base64(png));
}

std::string svgMarkup(const std::string& svg, const std::string& description) {
  std::string markup = svg.substr(svg.find("<svg"));
  markup.insert(4, fmt::format(" role=\"img\" aria-label=\"{}\"", escapeXml(description)));
  return markup;
}

std::string pageHtml(const ReportData& report, const std::vector<PageFigure>& figures) {
  data page = object();
  page.set("title", report.title);
  page.set("style", styleText);
  page.set("summary", paragraphs(report.summary));
  page.set("systems", systemsData(report));
  page.set("sections", sectionsData(report, figures));
  if (!report.notes.empty()) page.set("hasNotes", data("notes", notesData(report)));
  page.set("recipe", recipeData(report));
  kainjow::mustache::mustache view(templateText);
  if (!view.is_valid()) throw Error("report template: " + view.error_message());
  return view.render(page);
}

}  // namespace marey::report
