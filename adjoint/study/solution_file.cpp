#include "hbar/adjoint/study/solution_file.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "hbar/core/base/error.h"
#include "hbar/core/files/atomic_file.h"
#include "hbar/core/files/csv.h"
#include "hbar/core/files/numbers.h"
#include "hbar/core/files/result_file.h"
#include "hbar/core/files/row_checksum.h"
#include "hbar/core/files/text_file.h"

namespace hbar::study {
namespace {

constexpr const char* kFormat = "hbar-solution";
constexpr int kVersion = 3;

void check_count(Eigen::Index found, std::size_t expected, const char* what) {
  if (found != static_cast<Eigen::Index>(expected)) {
    throw InvalidInput(concat("save_solution: ", found, ' ', what, " for ", expected, " names"));
  }
}

std::string finite_number(double number, const std::string& of) {
  if (!std::isfinite(number)) {
    throw InvalidInput(concat("save_solution: a number of \"", of, "\" is not finite"));
  }
  return ',' + scene::format_number(number);
}

/// A solution as read, with the location of each name for error messages.
struct SolutionText {
  Solution solution;
  std::vector<scene::CsvCell> variables;    // name cells
  std::vector<scene::CsvCell> constraints;  // name cells
  scene::CsvCell end;                       // of the last row
  bool whole = false;                       // the row "end" was reached
};

void append(Eigen::VectorXd& numbers, double number) {
  numbers.conservativeResize(numbers.size() + 1);
  numbers[numbers.size() - 1] = number;
}

/// Reads one row by its first word.
void read_solution_row(scene::CsvRow row, const std::string& file, SolutionText& out) {
  const std::string kind = row[0].text;
  const std::map<std::string, std::size_t> cells = {
      {"status", 3},   {"objective", 3},  {"mu", 3}, {"about", 4},
      {"variable", 6}, {"constraint", 4}, {"end", 3}};
  const auto known = cells.find(kind);
  if (known == cells.end()) {
    scene::fail_at(row[0], file,
                   concat('"', scene::quotable(kind), "\" is nothing that a solution has"));
  }
  if (row.size() != known->second) {
    scene::fail_at(
        row.back(), file,
        concat("\"", kind, "\" has ", row.size() - 1, " entries; it takes ", known->second - 1));
  }
  if (kind != "end") {
    scene::take_checksum(row, file);
  }
  Solution& solution = out.solution;
  if (kind == "end") {
    out.whole = scene::integer_in(row[1], file) == static_cast<int>(out.variables.size()) &&
                scene::integer_in(row[2], file) == static_cast<int>(out.constraints.size());
  } else if (kind == "status") {
    solution.status = row[1].text;
  } else if (kind == "objective") {
    solution.objective = scene::number_in(row[1], file);
  } else if (kind == "mu") {
    solution.point.mu = scene::number_in(row[1], file);
  } else if (kind == "about") {
    solution.about[row[1].text] = row[2].text;
  } else if (kind == "variable") {
    solution.variable_names.push_back(row[1].text);
    out.variables.push_back(row[1]);
    append(solution.point.x, scene::number_in(row[2], file));
    append(solution.point.lower_multipliers, scene::number_in(row[3], file));
    append(solution.point.upper_multipliers, scene::number_in(row[4], file));
  } else {
    solution.constraint_names.push_back(row[1].text);
    out.constraints.push_back(row[1]);
    append(solution.point.constraint_multipliers, scene::number_in(row[2], file));
  }
}

SolutionText read_solution_text(const std::filesystem::path& path) {
  const std::string file = path.string();
  const std::vector<scene::CsvRow> rows = scene::parse_csv(scene::read_text_file(path), file);
  if (rows.empty() || rows[0].size() != 2 || rows[0][0].text != kFormat) {
    throw InvalidInput(
        concat(file, ":1: this is no solution, which begins with \"", kFormat, ",", kVersion, '"'));
  }
  if (scene::integer_in(rows[0][1], file) != kVersion) {
    scene::fail_at(rows[0][1], file,
                   concat("version ", rows[0][1].text, " of the format; known is ", kVersion));
  }
  SolutionText out;
  for (std::size_t i = 1; i < rows.size(); ++i) {
    read_solution_row(rows[i], file, out);
  }
  out.end = rows.back().back();
  if (!out.whole || rows.back()[0].text != "end") {
    scene::fail_at(
        out.end, file,
        concat("this solution is not whole: after ", out.variables.size(), " variables and ",
               out.constraints.size(), " constraints there is no line \"end\" that counts them"));
  }
  return out;
}

/// Refuses names that are not the program's.
void compare_names(const std::vector<scene::CsvCell>& found,
                   const std::vector<std::string>& expected, const char* what,
                   const scene::CsvCell& end, const std::string& file) {
  for (std::size_t i = 0; i < std::min(found.size(), expected.size()); ++i) {
    if (found[i].text == expected[i]) {
      continue;
    }
    scene::fail_at(found[i], file,
                   concat("another program's solution: ", what, ' ', i, " is \"",
                          scene::quotable(found[i].text), "\", not \"", expected[i], '"'));
  }
  if (found.size() != expected.size()) {
    scene::fail_at(found.size() > expected.size() ? found[expected.size()] : end, file,
                   concat("another program's solution: it has ", found.size(), ' ', what,
                          "s, the program ", expected.size()));
  }
}

/// @throws InvalidInput as save_solution
std::string solution_text(const Solution& solution) {
  const solvers::PrimalDualPoint& point = solution.point;
  const std::size_t n = solution.variable_names.size();
  const std::size_t m = solution.constraint_names.size();
  check_count(point.x.size(), n, "variables");
  check_count(point.lower_multipliers.size(), n, "multipliers of lower bounds");
  check_count(point.upper_multipliers.size(), n, "multipliers of upper bounds");
  check_count(point.constraint_multipliers.size(), m, "multipliers of constraints");

  std::string text = concat(kFormat, ',', kVersion, '\n');
  const auto add = [&text](const std::string& line) { text += scene::with_checksum(line) + '\n'; };
  add("status," + scene::csv_cell(solution.status));
  add("objective" + finite_number(solution.objective, "objective"));
  add("mu" + finite_number(point.mu, "mu"));
  for (const auto& [key, value] : solution.about) {
    add("about," + scene::csv_cell(key) + ',' + scene::csv_cell(value));
  }
  text += "# variable, name, value, multiplier of its lower bound, of its upper bound, checksum\n";
  for (std::size_t i = 0; i < n; ++i) {
    const std::string& name = solution.variable_names[i];
    const auto row = static_cast<Eigen::Index>(i);
    add("variable," + scene::csv_cell(name) + finite_number(point.x[row], name) +
        finite_number(point.lower_multipliers[row], name) +
        finite_number(point.upper_multipliers[row], name));
  }
  text += "# constraint, name, multiplier, checksum\n";
  for (std::size_t i = 0; i < m; ++i) {
    const std::string& name = solution.constraint_names[i];
    add("constraint," + scene::csv_cell(name) +
        finite_number(point.constraint_multipliers[static_cast<Eigen::Index>(i)], name));
  }
  return text + concat("end,", n, ',', m, '\n');
}

/// What is saved of a result; nothing if it has no finite point.
std::optional<std::string> result_text(const solvers::Nlp& nlp, const solvers::IpoptResult& result,
                                       std::map<std::string, std::string> about) {
  Solution solution = solution_of(nlp, result, std::move(about));
  const auto n = static_cast<Eigen::Index>(solution.variable_names.size());
  const bool reached =
      result.x.size() == n && result.x.allFinite() && std::isfinite(result.objective);
  if (!reached) {
    return std::nullopt;
  }
  solvers::PrimalDualPoint& point = solution.point;
  const auto m = static_cast<Eigen::Index>(solution.constraint_names.size());
  const auto mend = [](Eigen::VectorXd& multipliers, Eigen::Index size) {
    if (multipliers.size() != size || !multipliers.allFinite()) {
      multipliers.setZero(size);
    }
  };
  mend(point.lower_multipliers, n);
  mend(point.upper_multipliers, n);
  mend(point.constraint_multipliers, m);
  if (!std::isfinite(point.mu)) {
    point.mu = 0.0;
  }
  return solution_text(solution);
}

}  // namespace

Solution solution_of(const solvers::Nlp& nlp, const solvers::IpoptResult& result,
                     std::map<std::string, std::string> about) {
  return {.point = result.point(),
          .variable_names = nlp.variables().names,
          .constraint_names = nlp.constraint_limits().names,
          .objective = result.objective,
          .status = std::string(to_string(result.status)),
          .about = std::move(about)};
}

void save_solution(const std::filesystem::path& path, const Solution& solution) {
  scene::write_result_file(path, solution_text(solution));
}

Solution read_solution(const std::filesystem::path& path) {
  return read_solution_text(path).solution;
}

solvers::PrimalDualPoint load_solution(const std::filesystem::path& path, const solvers::Nlp& nlp) {
  const SolutionText text = read_solution_text(path);
  const std::string file = path.string();
  compare_names(text.variables, nlp.variables().names, "variable", text.end, file);
  compare_names(text.constraints, nlp.constraint_limits().names, "constraint", text.end, file);
  return text.solution.point;
}

void save_result(const solvers::Nlp& nlp, const solvers::IpoptResult& result,
                 const std::filesystem::path& path, std::map<std::string, std::string> about) {
  if (const std::optional<std::string> text = result_text(nlp, result, std::move(about))) {
    scene::write_result_file(path, *text);
  }
}

solvers::IpoptOptions saving_checkpoints(const solvers::Nlp& nlp, solvers::IpoptOptions options,
                                         const std::filesystem::path& path,
                                         const std::map<std::string, std::string>& about) {
  options.on_checkpoint = [&nlp, path, about, before = std::move(options.on_checkpoint)](
                              const solvers::IpoptResult& result) {
    if (before) {
      before(result);
    }
    try {
      if (const std::optional<std::string> text = result_text(nlp, result, about)) {
        scene::write_file_atomically(path, *text);
      }
    } catch (const IoError&) {  // the end of the work says it, and saves elsewhere
    }
  };
  return options;
}

solvers::IpoptResult solve_and_save(solvers::Nlp& nlp, const solvers::IpoptOptions& options,
                                    const std::filesystem::path& path,
                                    std::map<std::string, std::string> about) {
  scene::expect_result_file(path);
  solvers::IpoptResult result =
      solvers::solve_with_ipopt(nlp, saving_checkpoints(nlp, options, path, about));
  save_result(nlp, result, path, std::move(about));
  return result;
}

}  // namespace hbar::study
