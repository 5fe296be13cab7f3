// Offers to sample the sets of an opened document again: in the way of nothing, until it is
// answered.
#pragma once

#include <QToolBar>

class QLabel;

namespace marey::gui {

class Workspace;

class OfferBar : public QToolBar {
  Q_OBJECT
 public:
  explicit OfferBar(Workspace& workspace, QWidget* parent = nullptr);

 private:
  void refresh();

  Workspace& m_workspace;
  QLabel* m_text = nullptr;
};

}  // namespace marey::gui
