// SPDX-License-Identifier: BSD-3-Clause
#include "draw/label_space.h"

#include <cmath>

#include "draw/paths.h"
#include "draw/symbols.h"

namespace aquafarm_viz {
LabelSpace::LabelSpace(const FreeSpace& symbols, const aquafarm_msgs::FarmSpec& spec,
                       const Layout& layout)
    : spaces_{symbols, symbols, symbols} {
  const double half_cell = 0.5 * layout.view.cell_px();
  for (const Cover cover : {Cover::kNothing, Cover::kPaths}) {
    FreeSpace& water = spaces_[std::size_t(cover)];
    for (const auto& cell : spec.islands) {
      water.Block(Around(layout.view.ToPixel(cell.x, cell.y), half_cell));
    }
    for (const auto& rock : spec.rocks) {
      water.Block(Around(layout.view.ToPixel(rock.cell.x, rock.cell.y), 0.8 * half_cell));
    }
  }
}

void LabelSpace::BlockPaths(const aquafarm_msgs::FarmState& state, const Trail& paths,
                            const Layout& layout) {
  for (const auto& ship : state.ships) {
    const ShipTrail* way = ship.visible ? paths.Find(ship.id) : nullptr;
    if (way == nullptr) continue;
    for (const Moved& move : MovesOf(state, ship.id, *way, layout)) {
      spaces_[std::size_t(Cover::kNothing)].BlockLine(move.from, move.to,
                                                      layout.Px(11));  // as wide as an arrowhead
    }
  }
}

std::optional<cv::Rect> LabelSpace::Take(Cover cover, cv::Size size, cv::Point2d near,
                                         double farthest) {
  const auto place = spaces_[std::size_t(cover)].Find(size, near, farthest);
  if (place) Add(*place);
  return place;
}

std::optional<cv::Rect> LabelSpace::Take(cv::Size size, cv::Point2d near, double farthest) {
  for (const Cover cover : {Cover::kNothing, Cover::kPaths, Cover::kPathsAndLand}) {
    if (const auto place = Take(cover, size, near, farthest)) return place;
  }
  return std::nullopt;
}

void LabelSpace::Add(cv::Rect place) {
  for (FreeSpace& space : spaces_) space.Add(place);
}

bool LabelSpace::AddLine(cv::Point2d from, cv::Point2d to, cv::Rect label, int width) {
  if (spaces_.front().CrossesLabel(from, to, label)) return false;
  for (FreeSpace& space : spaces_) space.BlockLine(from, to, width);
  return true;
}

}  // namespace aquafarm_viz
