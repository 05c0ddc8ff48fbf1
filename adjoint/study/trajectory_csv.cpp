#include "hbar/adjoint/study/trajectory_csv.h"

#include <array>
#include <cmath>

#include "hbar/core/base/error.h"
#include "hbar/core/base/nearest_name.h"
#include "hbar/core/files/csv.h"
#include "hbar/core/files/numbers.h"

namespace hbar::study {
namespace {

/// A member of TrajectoryNames, and which member of TrajectoryValues it names.
struct NamedField {
  ValueField field;
  const std::vector<std::string> TrajectoryNames::*names;
  const char* alias;  ///< before a name, in the tables of the hbar command; null: none
};
constexpr std::array kNamedFields = {
    NamedField{ValueField::kQ, &TrajectoryNames::q, "q."},
    NamedField{ValueField::kQdot, &TrajectoryNames::qdot, "qdot."},
    NamedField{ValueField::kMeasured, &TrajectoryNames::measured, nullptr},
    NamedField{ValueField::kU, &TrajectoryNames::u, nullptr},
};

const Eigen::MatrixXd& member(const TrajectoryValues& values, ValueField field) {
  switch (field) {
    case ValueField::kQdot:
      return values.qdot;
    case ValueField::kMeasured:
      return values.measured;
    case ValueField::kU:
      return values.u;
    default:
      return values.q;
  }
}

/// The places that a column's name may mean, at step 0.
std::vector<ValuePlace> meanings(const std::string& name, const TrajectoryNames& names) {
  std::vector<ValuePlace> found;
  for (const NamedField& named : kNamedFields) {
    const std::vector<std::string>& list = names.*named.names;
    for (std::size_t i = 0; i < list.size(); ++i) {
      const bool rate = named.field == ValueField::kQdot;
      const bool by_alias =
          named.alias != nullptr && name == named.alias + (rate ? names.q[i] : list[i]);
      if (name == list[i] || by_alias) {
        found.push_back({.field = named.field, .step = 0, .index = static_cast<int>(i)});
      }
    }
  }
  return found;
}

std::vector<std::string> every_name(const TrajectoryNames& names) {
  std::vector<std::string> all;
  for (const NamedField& named : kNamedFields) {
    all.insert(all.end(), (names.*named.names).begin(), (names.*named.names).end());
  }
  return all;
}

/// The place of each column but the first, at step 0.
std::vector<ValuePlace> read_heading(const scene::CsvRow& heading, const std::string& file,
                                     const TrajectoryNames& names) {
  if (heading[0].text != "time") {
    scene::fail_at(
        heading[0], file,
        concat("the first column is \"", scene::quotable(heading[0].text), "\", not time"));
  }
  std::vector<ValuePlace> columns;
  for (std::size_t i = 1; i < heading.size(); ++i) {
    const std::string& name = heading[i].text;
    const std::vector<ValuePlace> found = meanings(name, names);
    if (found.empty()) {
      scene::fail_at(heading[i], file,
                     concat("unknown column \"", scene::quotable(name), "\"; ",
                            unknown_name_hint(name, every_name(names))));
    }
    if (found.size() > 1) {
      scene::fail_at(
          heading[i], file,
          concat("\"", scene::quotable(name), "\" names more than one number of this model"));
    }
    for (const ValuePlace& earlier : columns) {
      if (earlier == found[0]) {
        scene::fail_at(heading[i], file, concat("\"", scene::quotable(name), "\" is there twice"));
      }
    }
    columns.push_back(found[0]);
  }
  return columns;
}

/// The controls of a table.
class Controls {
 public:
  Controls(const TrajectoryNames& names, const std::vector<ValuePlace>& columns, int steps)
      : names_(names.u), steps_(steps), known_(names.u.size(), kNoColumn) {
    for (const ValuePlace& column : columns) {
      if (column.field == ValueField::kU) {
        known_[static_cast<std::size_t>(column.index)] = 0;
        u_.setZero(static_cast<Eigen::Index>(names_.size()), steps);
      }
    }
  }

  /// What acted until the end of step `end` − 1, since the value before.
  void set(int control, int end, double value) {
    int& known = known_[static_cast<std::size_t>(control)];
    u_.row(control).segment(known, end - known).setConstant(value);
    known = end;
  }

  [[nodiscard]] Eigen::MatrixXd take(const std::string& file) const {
    for (std::size_t i = 0; i < known_.size() && u_.size() > 0; ++i) {
      if (known_[i] == kNoColumn) {
        throw InvalidInput(concat(file, ": there is no column \"", names_[i],
                                  "\"; controls are given for every motor, or for none"));
      }
      if (known_[i] < steps_) {
        throw InvalidInput(concat(file, ": \"", names_[i], "\" has no value from step ", known_[i],
                                  " on; there are ", steps_, " steps"));
      }
    }
    return u_;
  }

 private:
  static constexpr int kNoColumn = -1;

  const std::vector<std::string>& names_;
  int steps_;
  std::vector<int> known_;  // steps whose control is known
  Eigen::MatrixXd u_;
};

int read_step(const scene::CsvCell& cell, const std::string& file, const TimeGrid& grid, int last) {
  const double time = scene::number_in(cell, file);
  const double steps = time / grid.h;
  const double nearest = std::round(steps);
  if (!(std::abs(steps - nearest) <= grid.tolerance)) {
    scene::fail_at(cell, file, concat("time ", cell.text, " is no multiple of the step ", grid.h));
  }
  if (nearest < 0.0 || nearest > grid.steps) {
    scene::fail_at(
        cell, file,
        concat("time ", cell.text, " is outside the simulation, 0 to ", grid.steps * grid.h));
  }
  const int step = static_cast<int>(nearest);
  if (step <= last) {
    scene::fail_at(cell, file, concat("time ", cell.text, " does not come after the row before"));
  }
  return step;
}

}  // namespace

TrajectoryNames trajectory_names(const Horizon& horizon) {
  const Model& model = horizon.model();
  TrajectoryNames names;
  for (int i = 0; i < model.dof(); ++i) {
    names.q.push_back(model.coordinate_name(i));
    names.qdot.push_back("rate." + names.q.back());
  }
  names.measured = horizon.measured_names();
  for (int i = 0; i < model.control_count(); ++i) {
    names.u.push_back("control." + model.control_name(i));
  }
  return names;
}

std::string trajectory_csv(const TrajectoryNames& names, const TrajectoryValues& values) {
  std::string text = "time";
  for (const NamedField& named : kNamedFields) {
    const std::vector<std::string>& list = names.*named.names;
    const Eigen::Index rows = member(values, named.field).rows();
    if (rows != static_cast<Eigen::Index>(list.size())) {
      throw InvalidInput(concat("trajectory_csv: ", rows, " rows for ", list.size(), " names"));
    }
    for (const std::string& name : list) {
      text += ',' + scene::csv_cell(name);
    }
  }
  for (Eigen::Index k = 0; k < values.q.cols(); ++k) {
    text += '\n' + scene::format_number(static_cast<double>(k) * values.h);
    for (const NamedField& named : kNamedFields) {
      const Eigen::MatrixXd& numbers = member(values, named.field);
      const Eigen::Index column = named.field == ValueField::kU ? k - 1 : k;
      for (Eigen::Index i = 0; i < numbers.rows(); ++i) {
        text += ',';
        if (column >= 0) {
          text += scene::format_number(numbers(i, column));
        }
      }
    }
  }
  return text + '\n';
}

Eigen::VectorXd TrajectoryData::by_column(const Eigen::VectorXd& numbers) const {
  if (numbers.size() != static_cast<Eigen::Index>(names.size())) {
    throw InvalidInput(concat("TrajectoryData::by_column: ", numbers.size(), " numbers for ",
                              names.size(), " columns"));
  }
  Eigen::VectorXd out(data.size());
  for (std::size_t i = 0; i < column.size(); ++i) {
    out[static_cast<Eigen::Index>(i)] = numbers[static_cast<Eigen::Index>(column[i])];
  }
  return out;
}

TrajectoryData read_trajectory_csv(std::string_view text, const std::string& file,
                                   const TrajectoryNames& names, const TimeGrid& grid) {
  if (!(grid.h > 0.0)) {
    throw InvalidInput(concat("read_trajectory_csv: the step is ", grid.h, ", but must be > 0"));
  }
  const std::vector<scene::CsvRow> rows = scene::parse_csv(text, file);
  if (rows.empty()) {
    throw InvalidInput(file + ":1: an empty table; it begins with a heading");
  }
  const std::vector<ValuePlace> columns = read_heading(rows[0], file, names);

  TrajectoryData out;
  for (std::size_t i = 1; i < rows[0].size(); ++i) {
    out.names.push_back(rows[0][i].text);
  }
  Controls controls(names, columns, grid.steps);
  std::vector<double> data;
  int last = -1;
  for (std::size_t r = 1; r < rows.size(); ++r) {
    const scene::CsvRow& row = rows[r];
    if (row.size() != rows[0].size()) {
      scene::fail_at(row.back(), file,
                     concat("a row of ", row.size(), " cells; the heading has ", rows[0].size()));
    }
    last = read_step(row[0], file, grid, last);
    for (std::size_t i = 1; i < row.size(); ++i) {
      if (row[i].text.empty()) {
        continue;
      }
      ValuePlace place = columns[i - 1];
      place.step = last;
      const double number = scene::number_in(row[i], file);
      if (place.field == ValueField::kU) {
        if (last == 0) {
          scene::fail_at(row[i], file, "a control at time 0, before the first step");
        }
        controls.set(place.index, last, number);
        continue;
      }
      data.push_back(number);
      out.places.push_back(place);
      out.column.push_back(i - 1);
    }
  }
  out.data = Eigen::Map<const Eigen::VectorXd>(data.data(), static_cast<Eigen::Index>(data.size()));
  out.u = controls.take(file);
  return out;
}

}  // namespace hbar::study
