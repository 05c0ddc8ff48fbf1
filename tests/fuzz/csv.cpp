// Tables of comma-separated values: their cells, and a table of measured numbers.

#include "hbar/core/files/csv.h"

#include "hbar/adjoint/study/trajectory_csv.h"
#include "hbar/core/base/error.h"
#include "tests/fuzz/target.h"

namespace hbar::fuzz {
namespace {

using scene::CsvCell;
using scene::CsvRow;
using study::TrajectoryData;

const study::TrajectoryNames kNames = {.q = {"a", "b, c"},
                                       .qdot = {"rate.a", "rate.b, c"},
                                       .measured = {"tip.x", "tip.y"},
                                       .u = {"control.a", "control.b"}};
constexpr study::TimeGrid kGrid = {.h = 0.1, .steps = 4};

/// Cells that are written and read again are the same.
void check_cells(const std::vector<CsvRow>& rows) {
  std::string text;
  std::vector<const CsvRow*> written;
  for (const CsvRow& row : rows) {
    if (row.size() == 1 && row[0].text.empty()) {
      continue;  // an empty line is no row
    }
    for (const CsvCell& cell : row) {
      text += (&cell == row.data() ? "" : ",") + scene::csv_cell(cell.text);
    }
    text += '\n';
    written.push_back(&row);
  }
  const std::vector<CsvRow> again = scene::parse_csv(text, "written.csv");
  require(again.size() == written.size(), "a table is read with other rows");
  for (std::size_t i = 0; i < again.size(); ++i) {
    require(again[i].size() == written[i]->size(), "a row is read with other cells");
    for (std::size_t j = 0; j < again[i].size(); ++j) {
      require(again[i][j].text == (*written[i])[j].text, "a cell is read differently");
    }
  }
}

/// Data that fills every place of a trajectory is written and read back the same.
void check_trajectory(const TrajectoryData& read) {
  require(read.data.allFinite() && read.u.allFinite(), "data that is not finite");
  TrajectoryValues values;
  values.h = kGrid.h;
  values.q = values.qdot = values.measured = Eigen::MatrixXd::Zero(2, kGrid.steps + 1);
  values.u = read.u;
  for (std::size_t i = 0; i < read.places.size(); ++i) {
    const ValuePlace& place = read.places[i];
    Eigen::MatrixXd& member = place.field == ValueField::kQ      ? values.q
                              : place.field == ValueField::kQdot ? values.qdot
                                                                 : values.measured;
    member(place.index, place.step) = read.data[static_cast<Eigen::Index>(i)];
  }
  study::TrajectoryNames names = kNames;
  if (values.u.size() == 0) {
    names.u.clear();
  }
  const std::string text = study::trajectory_csv(names, values);
  const TrajectoryData again = study::read_trajectory_csv(text, "written.csv", names, kGrid);
  require(again.u == values.u, "controls are read differently");
  require(study::trajectory_csv(names, values) == text, "a table is written differently");
  for (std::size_t i = 0; i < again.places.size(); ++i) {
    const ValuePlace& place = again.places[i];
    const Eigen::MatrixXd& member = place.field == ValueField::kQ      ? values.q
                                    : place.field == ValueField::kQdot ? values.qdot
                                                                       : values.measured;
    require(member(place.index, place.step) == again.data[static_cast<Eigen::Index>(i)],
            "a datum is read differently");
  }
}

}  // namespace

void try_input(std::string_view input) {
  check_cells(scene::parse_csv(input, "table.csv"));
  check_trajectory(study::read_trajectory_csv(input, "table.csv", kNames, kGrid));
}

}  // namespace hbar::fuzz
