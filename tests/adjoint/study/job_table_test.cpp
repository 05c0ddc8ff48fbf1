#include "hbar/adjoint/study/job_table.h"

#include <gtest/gtest.h>

#include "hbar/core/base/error.h"
#include "tests/support/message_of.h"
#include "tests/support/numerics.h"

namespace hbar::study {
namespace {

JobOptions small_study() {
  return {.name = "small", .seed = 7, .count = 3, .columns = {"length, m", "mass"}};
}

std::vector<std::optional<JobResult>> small_results() {
  return {JobResult{.converged = true,
                    .objective = 0.1,
                    .numbers = {1.0 / 3.0, -1e-300},
                    .status = "optimal",
                    .message = "said \"yes\",\nand more"},
          std::nullopt,
          JobResult{.failed = true, .numbers = {}, .status = "failed", .message = "threw"}};
}

TEST(JobTable, IsALinePerJobBelowAHeading) {
  EXPECT_EQ(job_table(small_study(), small_results()),
            "# study \"small\", seed 7, 3 jobs\n"
            "job,outcome,objective,\"length, m\",mass,status,message,checksum\n"
            "0,converged,0.1,0.3333333333333333,-1e-300,optimal,\"said \"\"yes\"\",\nand "
            "more\",9bd75e4b\n"
            "2,failed,,,,failed,threw,1666741d\n");
}

TEST(JobTable, IsReadToTheLastBit) {
  const JobOptions options = small_study();
  const std::string text = job_table(options, small_results());
  const auto results = read_job_table(text, options, "t.csv");
  ASSERT_EQ(results.size(), 3U);
  EXPECT_EQ(results[0]->numbers, small_results()[0]->numbers);
  EXPECT_EQ(results[0]->message, small_results()[0]->message);
  EXPECT_FALSE(results[1].has_value());
  EXPECT_TRUE(results[2]->failed);
  EXPECT_EQ(job_table(options, results), text);
}

TEST(JobTable, OfAnotherStudyIsRefused) {
  const std::string text = job_table(small_study(), small_results());
  const auto refusal = [&](const JobOptions& options) {
    return testing::message_of<InvalidInput>([&] { (void)read_job_table(text, options, "t.csv"); });
  };
  EXPECT_EQ(refusal(small_study()), "");
  JobOptions options = small_study();
  options.name = "large";
  EXPECT_EQ(refusal(options),
            "t.csv:1: \"# study \"small\", seed 7, 3 jobs\", but this is \"# study \"large\", seed "
            "7, 3 jobs\"; give it a table of its own");
  options = small_study();
  options.seed = 8;
  EXPECT_EQ(refusal(options).substr(0, 8), "t.csv:1:");
  options = small_study();
  options.columns[1] = "width";
  EXPECT_EQ(refusal(options),
            "t.csv:2: column 5 is not \"width\", as in this study; give it a table of its own");
}

TEST(JobTable, ThatWasDamagedIsRefusedWithThePlace) {
  const JobOptions options = small_study();
  const std::string head = job_table(options, {});
  const auto refusal = [&](const std::string& line) {
    return testing::message_of<InvalidInput>(
        [&] { (void)read_job_table(head + line, options, "t.csv"); });
  };
  EXPECT_EQ(refusal("1,ended,2,3,4,,,"), "");
  EXPECT_EQ(refusal("3,ended,2,3,4,,,"), "t.csv:3:1: job 3 is not one of 0 to 2");
  EXPECT_EQ(refusal("1,lost,2,3,4,,,"), "t.csv:3:3: \"lost\" is not converged, ended or failed");
  EXPECT_EQ(refusal("1,ended,2,3x,4,,,"), "t.csv:3:11: \"3x\" is not a finite number");
  EXPECT_EQ(
      refusal("1,ended,2,3,4,,,00000000"),
      "t.csv:3:17: this line was changed or damaged after it was written: its checksum is "
      "\"00000000\" and not 1a55bc6f; restore it, or empty this cell to take the line as it is");
  EXPECT_EQ(refusal("1,ended,2,3"), "t.csv:3:11: a line of 4 cells; the heading has 8");
}

}  // namespace
}  // namespace hbar::study
