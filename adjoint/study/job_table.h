#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "hbar/adjoint/study/job.h"
#include "hbar/core/files/csv.h"

namespace hbar::study {

/// A result as a line of the table of results, without its end.
[[nodiscard]] std::string job_line(int index, const JobResult& result, std::size_t columns);

/// The table of results: a comment that names the study, a heading, and one line per finished job.
[[nodiscard]] std::string job_table(const JobOptions& options,
                                    const std::vector<std::optional<JobResult>>& results);

/// A line's index and result.
///
/// @param row      of a table of results
/// @param options  of its study
/// @param file     for messages
/// @throws InvalidInput that begins `file:line:column:`, also for a line that its checksum (see
///   row_checksum.h) shows to be damaged
[[nodiscard]] std::pair<int, JobResult> read_job(scene::CsvRow row, const JobOptions& options,
                                                 const std::string& file);

/// The contents of a table of results.                                                 [count]
///
/// @param text  the file's bytes
/// @throws InvalidInput that begins `file:line:` if it belongs to another study or is damaged
[[nodiscard]] std::vector<std::optional<JobResult>> read_job_table(std::string_view text,
                                                                   const JobOptions& options,
                                                                   const std::string& file);

}  // namespace hbar::study
