// The table of results of a study that is resumed.

#include "hbar/adjoint/study/job_table.h"

#include "tests/fuzz/target.h"

namespace hbar::fuzz {

void try_input(std::string_view input) {
  const study::JobOptions options = {
      .name = "fuzz", .seed = 7, .count = 4, .columns = {"length, m", "mass"}};
  const auto results = study::read_job_table(input, options, "jobs.csv");
  require(results.size() == 4, "another number of jobs");
  const std::string text = study::job_table(options, results);
  const auto again = study::read_job_table(text, options, "written.csv");
  for (std::size_t i = 0; i < results.size(); ++i) {
    require(results[i].has_value() == again[i].has_value(), "a job is lost");
    if (results[i]) {
      require(results[i]->numbers == again[i]->numbers, "numbers are read differently");
      require(results[i]->status == again[i]->status, "a status is read differently");
      require(results[i]->message == again[i]->message, "a message is read differently");
    }
  }
  require(study::job_table(options, again) == text, "a table is written differently");
}

}  // namespace hbar::fuzz
