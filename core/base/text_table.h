// Tables of text (CSV) with a row of names: commas, semicolons or tabs, quotes, line ends of any
// system, a byte-order mark, remarks (#) and blank lines.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "base/error.h"

namespace marey {

class TextTable {
 public:
  struct Row {
    int64_t line = 0;                 ///< 1-based
    std::vector<std::string> fields;  ///< without blanks and quotes around them
  };

  /// `expected` is what errors say where there is no table. A first row of numbers alone is no row
  /// of names: columns() is then empty. Throws InputError for an empty text and for rows of other
  /// widths than the first.
  TextTable(const std::string& text, std::string origin, const std::string& expected);

  /// In lower case and without units: "Time_s" is "time", as are "t" and "seconds".
  const std::vector<std::string>& columns() const { return m_columns; }
  /// As they are written.
  const std::vector<std::string>& titles() const { return m_titles; }
  const std::vector<Row>& rows() const { return m_rows; }
  size_t width() const { return m_width; }
  const std::string& origin() const { return m_origin; }
  int64_t firstLine() const { return m_firstLine; }  ///< of the names or, without, of the first row

  std::optional<size_t> find(const std::string& column) const;
  Place place(const Row& row, const std::string& item = {}) const;
  /// Nothing where the field is empty. Throws InputError for what is no finite number.
  std::optional<double> number(const Row& row, size_t column) const;

 private:
  std::string m_origin;
  std::vector<std::string> m_columns, m_titles;
  std::vector<Row> m_rows;
  size_t m_width = 0;
  int64_t m_firstLine = 0;
};

}  // namespace marey
