#include "hbar/adjoint/study/job_table.h"

#include "hbar/core/base/error.h"
#include "hbar/core/files/numbers.h"
#include "hbar/core/files/row_checksum.h"

namespace hbar::study {
namespace {

// What a line holds beside the numbers: job, outcome, objective before them, status, message and
// checksum after them.
constexpr std::size_t kBefore = 3;
constexpr std::size_t kAfter = 3;

std::string study_line(const JobOptions& options) {
  return concat("# study \"", scene::quotable(options.name), "\", seed ", options.seed, ", ",
                options.count, " jobs");
}

std::string heading_line(const JobOptions& options) {
  std::string text = "job,outcome,objective";
  for (const std::string& column : options.columns) {
    text += ',' + scene::csv_cell(column);
  }
  return text + ",status,message,checksum";
}

std::string outcome_word(const JobResult& result) {
  return result.failed ? "failed" : result.converged ? "converged" : "ended";
}

}  // namespace

std::string job_line(int index, const JobResult& result, std::size_t columns) {
  std::string text = concat(index, ',', outcome_word(result), ',');
  if (!result.failed) {
    text += scene::format_number(result.objective);
  }
  for (std::size_t i = 0; i < columns; ++i) {
    text += ',';
    if (!result.failed) {
      text += scene::format_number(result.numbers[i]);
    }
  }
  return scene::with_checksum(text + ',' + scene::csv_cell(result.status) + ',' +
                              scene::csv_cell(result.message));
}

std::string job_table(const JobOptions& options,
                      const std::vector<std::optional<JobResult>>& results) {
  std::string text = study_line(options) + '\n' + heading_line(options) + '\n';
  for (std::size_t i = 0; i < results.size(); ++i) {
    if (!results[i]) {
      continue;
    }
    text += job_line(static_cast<int>(i), *results[i], options.columns.size()) + '\n';
  }
  return text;
}

std::pair<int, JobResult> read_job(scene::CsvRow row, const JobOptions& options,
                                   const std::string& file) {
  const std::size_t columns = options.columns.size();
  if (row.size() != kBefore + columns + kAfter) {
    scene::fail_at(
        row.back(), file,
        concat("a line of ", row.size(), " cells; the heading has ", kBefore + columns + kAfter));
  }
  scene::take_checksum(row, file);
  const int index = scene::integer_in(row[0], file);
  if (index < 0 || index >= options.count) {
    scene::fail_at(row[0], file, concat("job ", index, " is not one of 0 to ", options.count - 1));
  }
  JobResult result;
  const std::string& outcome = row[1].text;
  result.converged = outcome == "converged";
  result.failed = outcome == "failed";
  if (!result.converged && !result.failed && outcome != "ended") {
    scene::fail_at(row[1], file,
                   concat('"', scene::quotable(outcome), "\" is not converged, ended or failed"));
  }
  if (!result.failed) {
    result.objective = scene::number_in(row[2], file);
    for (std::size_t i = 0; i < columns; ++i) {
      result.numbers.push_back(scene::number_in(row[kBefore + i], file));
    }
  }
  result.status = row[kBefore + columns].text;
  result.message = row[kBefore + columns + 1].text;
  return {index, result};
}

std::vector<std::optional<JobResult>> read_job_table(std::string_view text,
                                                     const JobOptions& options,
                                                     const std::string& file) {
  const std::string_view first = text.substr(0, text.find('\n'));
  if (first != study_line(options)) {
    throw InvalidInput(concat(file, ":1: \"", scene::quotable(first), "\", but this is \"",
                              study_line(options), "\"; give it a table of its own"));
  }
  const std::vector<scene::CsvRow> rows = scene::parse_csv(text, file);
  const std::vector<scene::CsvRow> heading = scene::parse_csv(heading_line(options), file);
  std::vector<std::optional<JobResult>> results(static_cast<std::size_t>(options.count));
  for (std::size_t i = 0; i < heading[0].size(); ++i) {
    const std::string& expected = heading[0][i].text;
    if (rows.empty() || i >= rows[0].size() || rows[0][i].text != expected) {
      throw InvalidInput(concat(file, ":2: column ", i + 1, " is not \"", scene::quotable(expected),
                                "\", as in this study; give it a table of its own"));
    }
  }
  for (std::size_t i = 1; i < rows.size(); ++i) {
    auto [index, result] = read_job(rows[i], options, file);
    results[static_cast<std::size_t>(index)] = std::move(result);
  }
  return results;
}

}  // namespace hbar::study
