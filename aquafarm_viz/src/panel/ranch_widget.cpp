// SPDX-License-Identifier: BSD-3-Clause
#include "ranch_widget.h"

#include <QGridLayout>
#include <QHBoxLayout>
#include <QHeaderView>
#include <QIcon>
#include <QPainter>
#include <QVBoxLayout>
#include <algorithm>
#include <climits>
#include <utility>

#include "aquafarm_viz/base/disaster_kinds.h"
#include "aquafarm_viz/base/palette.h"

namespace aquafarm_viz {
namespace {

// Returns the height of a row of a table [pixels].
int RowHeight(const QTableWidget* table) { return std::max(20, table->fontMetrics().height() + 2); }

QTableWidget* MakeTable(const RanchModel::Row& columns) {
  auto* table = new QTableWidget(0, static_cast<int>(columns.size()));
  QStringList names;
  for (const std::string& column : columns) names << Text(column);
  table->setHorizontalHeaderLabels(names);
  table->horizontalHeader()->setSectionResizeMode(QHeaderView::Stretch);
  table->horizontalHeader()->setMinimumSectionSize(30);
  table->verticalHeader()->hide();
  table->verticalHeader()->setMinimumSectionSize(RowHeight(table));
  table->verticalHeader()->setDefaultSectionSize(RowHeight(table));
  table->setEditTriggers(QAbstractItemView::NoEditTriggers);
  table->setSelectionMode(QAbstractItemView::NoSelection);
  return table;
}

// Fills a table with rows. The table is tall enough for all rows, but if there is no space it may
// shrink to `rows_seen` rows with a scroll bar.
void Fill(QTableWidget* table, const std::vector<RanchModel::Row>& rows, int rows_seen) {
  const int count = static_cast<int>(rows.size());
  table->setRowCount(count);
  const int head_px = table->horizontalHeader()->sizeHint().height() + 2 * table->frameWidth();
  table->setMinimumHeight(head_px + RowHeight(table) * std::clamp(count, 1, rows_seen));
  table->setMaximumHeight(head_px + RowHeight(table) * std::max(count, 1));
  for (int y = 0; y < table->rowCount(); ++y) {
    const RanchModel::Row& row = rows[static_cast<std::size_t>(y)];
    for (int x = 0; x < table->columnCount(); ++x) {
      if (table->item(y, x) == nullptr) table->setItem(y, x, new QTableWidgetItem());
      table->item(y, x)->setText(Text(row[static_cast<std::size_t>(x)]));
    }
  }
}

// Returns the symbol of a device kind, as in pictures.
QIcon DeviceIcon(std::uint8_t kind) {
  constexpr int kSide = 32;
  QPixmap symbol(kSide, kSide);
  symbol.fill(Qt::transparent);
  QPainter painter(&symbol);
  painter.setRenderHint(QPainter::Antialiasing);
  QPolygonF outline;
  for (const cv::Point2f& point : DeviceOutline(kind)) {
    outline << QPointF(kSide / 2.0 + 13.0 * double(point.x), kSide / 2.0 - 13.0 * double(point.y));
  }
  const Rgb color = DeviceColor(kind);
  painter.setPen(QPen(QColor(kInk.r, kInk.g, kInk.b), 2.0));
  painter.setBrush(QColor(color.r, color.g, color.b));
  painter.drawPolygon(outline);
  painter.end();
  return QIcon(symbol);
}

}  // namespace

RanchWidget::RanchWidget(const RanchModel& model, RanchButtons buttons, QWidget* parent)
    : QWidget(parent), model_(model), buttons_(std::move(buttons)) {
  auto* all = new QVBoxLayout(this);
  all->setContentsMargins(6, 6, 6, 6);
  all->setSpacing(4);
  headline_ = AddLine(all);
  QFont bold = headline_->font();
  bold.setBold(true);
  headline_->setFont(bold);
  reward_ = AddLine(all);
  all->addWidget(ships_ = MakeTable(RanchModel::ShipColumns()), 1);
  all->addWidget(devices_ = MakeTable(RanchModel::DeviceColumns()), 2);
  for (const int column : {1, 3}) {  // "kind" with symbols, and "status" with dangers
    devices_->horizontalHeader()->setSectionResizeMode(column, QHeaderView::ResizeToContents);
  }
  all->addWidget(disasters_ = MakeTable(RanchModel::DisasterColumns()), 1);
  disasters_->setObjectName("disasters");
  disasters_->horizontalHeader()->setSectionResizeMode(QHeaderView::ResizeToContents);
  disasters_->horizontalHeader()->setStretchLastSection(true);
  plan_ = AddLine(all);
  plan_->setObjectName("plan");
  all->addWidget(plan_ships_ = MakeTable(PlanShipColumns()), 1);
  plan_ships_->setObjectName("plan_ships");
  all->addWidget(plan_devices_ = MakeTable(PlanDeviceColumns()), 2);
  plan_devices_->setObjectName("plan_devices");
  training_ = AddLine(all);
  all->addWidget(curve_ = new CurveWidget(), 2);
  AddTime(all);
  AddPlaces(all);
  AddHelm(all);
  AddDisaster(all);
  message_ = AddLine(all);
  all->addWidget(region_ = new RegionWidget(), 3);
  region_->setObjectName("region");
  all->addStretch();
  ShowMessage("");
  Refresh();
}

QLabel* RanchWidget::AddLine(QBoxLayout* layout) {
  auto* line = new QLabel();
  line->setWordWrap(true);
  line->setTextFormat(Qt::PlainText);  // text from the network must not be parsed as markup
  line->setTextInteractionFlags(Qt::TextSelectableByMouse);
  layout->addWidget(line);
  return line;
}

QPushButton* RanchWidget::AddButton(QBoxLayout* layout, const QString& text,
                                    std::function<void()> act) {
  auto* button = new QPushButton(text.left(1).toUpper() + text.mid(1));
  button->setObjectName(text);
  button->setFocusPolicy(Qt::TabFocus);
  connect(button, &QPushButton::clicked, this, [act = std::move(act)] { act(); });
  layout->addWidget(button);
  return button;
}

void RanchWidget::AddTime(QBoxLayout* layout) {
  auto* row = new QHBoxLayout();
  layout->addLayout(row);
  AddButton(row, "pause", [this] { buttons_.pause(true, 0); });
  AddButton(row, "resume", [this] { buttons_.pause(false, 0); });
  AddButton(row, "step", [this] { buttons_.pause(true, 1); });
  auto* pace = new QComboBox();
  pace->addItem("keep", "");
  pace->addItem("paced", "paced");
  pace->addItem("lockstep", "lockstep");
  pace->setToolTip(
      "keep: changes only the rate. paced: a step at fixed intervals. lockstep: a step when "
      "every ship has a command");
  auto* rate = new QDoubleSpinBox();
  rate->setObjectName("rate");
  rate->setRange(0.1, 1000.0);
  rate->setValue(4.0);
  rate->setSuffix(" steps/s");
  row->addWidget(pace);
  row->addWidget(rate);
  AddButton(row, "pace", [this, pace, rate] {
    buttons_.set_pace(pace->currentData().toString().toStdString(), rate->value());
  });
}

void RanchWidget::AddPlaces(QBoxLayout* layout) {
  auto* row = new QHBoxLayout();
  layout->addLayout(row);
  const auto number = [row](const char* name) {
    auto* box = new QSpinBox();
    box->setObjectName(name);
    box->setRange(0, INT_MAX);
    box->setPrefix(QString(name) + " ");
    row->addWidget(box, 1);
    return box;
  };
  QSpinBox* seed = number("seed");
  seed->setValue(1);
  AddButton(row, "reset", [this, seed] { buttons_.reset(std::uint64_t(seed->value())); });
  QSpinBox* step = number("step");
  AddButton(row, "jump", [this, step] {
    buttons_.jump(std::uint64_t(step->value()));
  })->setToolTip("in a replay: shows this step of the current episode");
}

void RanchWidget::AddHelm(QBoxLayout* layout) {
  auto* row = new QHBoxLayout();
  layout->addLayout(row);
  ship_ = new QSpinBox();
  ship_->setPrefix("ship ");
  ship_->setRange(0, 4095);
  row->addWidget(ship_);
  auto* rose = new QGridLayout();
  rose->setSpacing(2);
  row->addLayout(rose);
  // Values of Command.action, arranged as on a compass with north up; 10 is hold.
  static constexpr std::uint8_t kRose[3][3]{{4, 0, 5}, {2, 10, 3}, {6, 1, 7}};
  for (int y = 0; y < 3; ++y) {
    for (int x = 0; x < 3; ++x) {
      const std::uint8_t action = kRose[y][x];
      auto* cell = new QHBoxLayout();
      rose->addLayout(cell, y, x);
      const int bearing = MoveBearingDeg(action);
      const QString name = bearing < 0 ? QString("hold") : Text(CompassPoint(bearing));
      AddButton(cell, name, [this, action] {
        buttons_.drive(ship_->value(), action);
      })->setMinimumWidth(30);
    }
  }
  auto* cargo = new QVBoxLayout();
  row->addLayout(cargo);
  AddButton(cargo, "pickup", [this] { buttons_.drive(ship_->value(), 8); });
  AddButton(cargo, "drop-off", [this] { buttons_.drive(ship_->value(), 9); });
}

void RanchWidget::AddDisaster(QBoxLayout* layout) {
  auto* row = new QHBoxLayout();
  layout->addLayout(row);
  auto* kind = new QComboBox();
  for (std::size_t i = 0; i < DisasterKindCount(); ++i) {
    kind->addItem(Text(DisasterName(static_cast<std::uint8_t>(i))));
  }
  auto* grade = new QComboBox();
  grade->addItems({"blue", "yellow", "orange", "red"});
  grade->setCurrentIndex(2);
  auto* radius = new QDoubleSpinBox();
  radius->setRange(0.5, 1000.0);
  radius->setValue(4.0);
  radius->setPrefix("radius ");
  for (QWidget* box :
       {static_cast<QWidget*>(kind), static_cast<QWidget*>(grade), static_cast<QWidget*>(radius)}) {
    row->addWidget(box, 1);
  }
  AddButton(row, "send disaster", [this, kind, grade, radius] {
    buttons_.send_disaster(
        model_.NextDisaster(),
        model_.MakeDisaster(static_cast<std::uint8_t>(kind->currentIndex()),
                            static_cast<std::uint8_t>(grade->currentIndex() + 1), radius->value()));
  })->setToolTip("adds a disaster at the cell of ship 0");
}

void RanchWidget::Refresh() {
  headline_->setText(Text(model_.Headline()));
  reward_->setText(Text(model_.RewardLine()));
  training_->setText(Text(model_.TrainingLine()));
  Fill(ships_, model_.Ships(), 2);
  Fill(devices_, model_.Devices(), 4);
  AddSymbols();
  const bool has_curve = !model_.curve().empty();  // true: no space for the disasters
  if (!has_curve) Fill(disasters_, model_.Disasters(), 2);
  disasters_->setVisible(!has_curve && disasters_->rowCount() > 0);
  curve_->Show(model_.curve());
  curve_->setVisible(has_curve);
  region_->Show(model_.shown(), !has_curve && model_.plan() == nullptr);  // there is space
  RefreshPlan();
}

void RanchWidget::AddSymbols() {
  if (model_.shown().state == nullptr) return;
  const auto& devices = model_.shown().state->devices;
  for (int row = 0; row < devices_->rowCount(); ++row) {
    const std::uint8_t kind = devices[static_cast<std::size_t>(row)].kind;
    if (icons_.count(kind) == 0) icons_.emplace(kind, DeviceIcon(kind));
    devices_->item(row, 1)->setIcon(icons_.at(kind));
  }
}

void RanchWidget::RefreshPlanAge() {
  if (model_.plan() == nullptr) return;
  const double silent_s = model_.PlanSilence(ros::SteadyTime::now());
  const QString text = Text(PlanHeadline(*model_.plan(), silent_s));
  if (plan_->text() != text) plan_->setText(text);
}

void RanchWidget::RefreshPlan() {
  const auto& plan = model_.plan();
  for (QWidget* part : {static_cast<QWidget*>(plan_), static_cast<QWidget*>(plan_ships_),
                        static_cast<QWidget*>(plan_devices_)}) {
    part->setVisible(plan != nullptr);
  }
  if (plan == nullptr) return;
  RefreshPlanAge();
  Fill(plan_ships_, PlanShips(*plan, model_.PlanNow()), 2);
  Fill(plan_devices_, PlanDevices(*plan), 4);
}

void RanchWidget::ShowMessage(const std::string& line) {
  message_->setText(Text(line));
  message_->setVisible(!line.empty());
}

}  // namespace aquafarm_viz
