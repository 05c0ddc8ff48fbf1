#include "hbar/adjoint/study/many_starts.h"

#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <stdexcept>

#include "hbar/core/base/error.h"
#include "hbar/core/files/text_file.h"
#include "hbar/solvers/nlp/ipopt.h"
#include "tests/support/message_of.h"
#include "tests/support/numerics.h"
#include "tests/support/programs.h"
#include "tests/support/temporary_folder.h"

namespace hbar::study {
namespace {

namespace fs = std::filesystem;

/// Random numbers of its own, and an objective that is least at 3.
JobResult draw_job(int index, std::mt19937_64& random) {
  const double drawn = static_cast<double>(random() >> 11U) * 0x1p-53;
  return {.converged = index != 2,
          .objective = std::abs(index - 3.25),
          .numbers = {drawn, 1.0 / (index + 1.0)},
          .status = "optimal",
          .message = {}};
}

JobOptions draw_study(const std::filesystem::path& table, int workers) {
  return {.name = "draw",
          .seed = 42,
          .count = 7,
          .columns = {"drawn", "share"},
          .table = table,
          .workers = workers};
}

class ManyStarts : public ::testing::Test {
 protected:
  [[nodiscard]] std::string text_of(const char* name) const {
    return scene::read_text_file(folder_ / name);
  }
  scene::TemporaryFolder folder_;
};

TEST_F(ManyStarts, HaveTheSameResultsForAnyNumberOfWorkers) {
  for (const int workers : {1, 4}) {
    const JobReport report =
        run_jobs(draw_study(folder_ / (workers == 1 ? "one" : "four"), workers), draw_job);
    EXPECT_TRUE(report.complete());
    EXPECT_EQ(report.ran, 7);
    EXPECT_EQ(report.kept, 0);
    EXPECT_EQ(report.best(), 3);
    for (int i = 0; i < 7; ++i) {
      std::mt19937_64 random = job_random(42, i);
      EXPECT_EQ(report.results[static_cast<std::size_t>(i)]->numbers, draw_job(i, random).numbers);
    }
  }
  EXPECT_EQ(text_of("one"), text_of("four"));
  EXPECT_EQ(folder_.count(), 2);
}

TEST_F(ManyStarts, DrawDifferentNumbersForEverySeedAndIndex) {
  EXPECT_EQ(job_random(1, 2)(), job_random(1, 2)());
  EXPECT_NE(job_random(1, 2)(), job_random(1, 3)());
  EXPECT_NE(job_random(1, 2)(), job_random(2, 2)());
  EXPECT_NE(job_random(1, 2)(), job_random(1 + (std::uint64_t{1} << 32U), 2)());
}

TEST_F(ManyStarts, GoOnWhereTheTableEnds) {
  run_jobs(draw_study(folder_ / "whole", 2), draw_job);
  JobOptions options = draw_study(folder_ / "parts", 2);
  options.most = 3;
  const JobReport first = run_jobs(options, draw_job);
  EXPECT_EQ(first.ran, 3);
  EXPECT_FALSE(first.complete());
  EXPECT_FALSE(first.results[3].has_value());

  options.most = 100;
  std::vector<int> done;
  options.on_job = [&](int index, const JobResult&) { done.push_back(index); };
  const JobReport second = run_jobs(options, draw_job);
  std::sort(done.begin(), done.end());
  EXPECT_EQ(done, (std::vector<int>{3, 4, 5, 6}));
  EXPECT_EQ(second.kept, 3);
  EXPECT_EQ(second.ran, 4);
  EXPECT_EQ(text_of("parts"), text_of("whole"));
  EXPECT_EQ(run_jobs(options, draw_job).ran, 0);
}

TEST_F(ManyStarts, LoseNoMoreThanRunningJobsWhenTheParentIsKilled) {
  JobOptions options = draw_study(folder_ / "table", 1);
  const pid_t parent = ::fork();
  if (parent == 0) {
    options.on_job = [](int index, const JobResult&) {
      if (index == 2) {
        ::raise(SIGKILL);
      }
    };
    run_jobs(options, draw_job);
    ::_exit(0);
  }
  int status = 0;
  ASSERT_EQ(::waitpid(parent, &status, 0), parent);
  ASSERT_TRUE(WIFSIGNALED(status));
  const JobReport report = run_jobs(options, draw_job);
  EXPECT_EQ(report.kept, 3);
  EXPECT_EQ(report.ran, 4);
}

TEST_F(ManyStarts, RecordWhatFailsAndGoOn) {
  JobOptions options = draw_study(folder_ / "table", 3);
  const Job job = [](int index, std::mt19937_64& random) {
    JobResult result = draw_job(index, random);
    if (index == 0) {
      throw std::runtime_error("no, thanks");
    }
    if (index == 1) {
      ::signal(SIGSEGV, SIG_DFL);
      ::raise(SIGSEGV);
    }
    if (index == 2) {
      throw 7;
    }
    if (index == 3) {
      result.numbers[1] = std::nan("");
    }
    if (index == 4) {
      result.numbers.pop_back();
    }
    if (index == 5) {
      ::_exit(3);
    }
    return result;
  };
  const JobReport report = run_jobs(options, job);
  EXPECT_TRUE(report.complete());
  const std::vector<std::string> said = {
      "threw: no, thanks",
      "ended by signal 11",
      "threw what is no std::exception",
      "share is not finite",
      "the job returned 1 numbers for 2 columns",
      "ended with code 3 and without a result",
  };
  for (std::size_t i = 0; i < said.size(); ++i) {
    EXPECT_TRUE(report.results[i]->failed) << i;
    EXPECT_EQ(report.results[i]->message.substr(0, said[i].size()), said[i]);
  }
  EXPECT_FALSE(report.results[6]->failed);
  EXPECT_EQ(report.best(), 6);

  EXPECT_EQ(run_jobs(options, draw_job).ran, 0);
  options.retry_failed = true;
  EXPECT_EQ(run_jobs(options, draw_job).ran, 6);
  run_jobs(draw_study(folder_ / "whole", 2), draw_job);
  EXPECT_EQ(text_of("table"), text_of("whole"));
}

TEST_F(ManyStarts, EndAJobThatHangs) {
  JobOptions options = draw_study(folder_ / "table", 1);
  options.most = 1;
  options.time_limit = 0.05;
  const JobReport report = run_jobs(options, [](int, std::mt19937_64&) -> JobResult {
    while (true) {
      ::pause();
    }
  });
  ASSERT_TRUE(report.results[0].has_value());
  EXPECT_TRUE(report.results[0]->failed);
  EXPECT_EQ(report.results[0]->message, "exceeded the limit of 0.05 s");
}

TEST_F(ManyStarts, StopWhenTheFlagIsSet) {
  std::atomic<bool> stop = false;
  JobOptions options = draw_study(folder_ / "table", 2);
  options.stop = &stop;
  options.on_job = [&](int, const JobResult&) { stop = true; };
  const JobReport report = run_jobs(options, [](int index, std::mt19937_64& random) {
    if (index > 0) {
      ::pause();
    }
    return draw_job(index, random);
  });
  EXPECT_EQ(report.ran, 1);
  EXPECT_TRUE(report.results[0].has_value());
  EXPECT_FALSE(report.results[1].has_value());
  EXPECT_EQ(::waitpid(-1, nullptr, WNOHANG), -1);  // no child is left
}

/// (x² − 1)² + x / 5, which is least near −1 and has another minimum near 1.
class TwoMinima : public solvers::testing::Program {
 public:
  explicit TwoMinima(double start) : Program(Eigen::VectorXd::Constant(1, start), 0) {}
  double objective(const Eigen::VectorXd& x) override {
    return std::pow(x[0] * x[0] - 1.0, 2) + 0.2 * x[0];
  }
  void objective_gradient(const Eigen::VectorXd& x, Eigen::VectorXd& g) override {
    g[0] = 4.0 * x[0] * (x[0] * x[0] - 1.0) + 0.2;
  }
  void constraints(const Eigen::VectorXd&, Eigen::VectorXd&) override {}
  void constraint_jacobian(const Eigen::VectorXd&, Eigen::VectorXd&) override {}
};

TEST_F(ManyStarts, FindTheBestOfSeveralMinimaWithIpopt) {
  const Job job = [](int index, std::mt19937_64&) {
    TwoMinima program(index == 2 ? -0.9 : 0.9 + 0.1 * index);
    const solvers::IpoptResult result = solve_with_ipopt(program, {});
    return JobResult{.converged = result.converged(),
                     .objective = result.objective,
                     .numbers = {result.x[0]},
                     .status = std::string(to_string(result.status))};
  };
  const JobReport report =
      run_jobs({.name = "minima", .count = 4, .columns = {"x"}, .workers = 2}, job);
  ASSERT_TRUE(report.complete());
  for (const auto& result : report.results) {
    EXPECT_EQ(result->status, "optimal");
  }
  EXPECT_EQ(report.best(), 2);
  EXPECT_NEAR(report.results[2]->numbers[0], -1.0241, 1e-4);
  EXPECT_NEAR(report.results[0]->numbers[0], 0.9740, 1e-4);
}

TEST_F(ManyStarts, RefuseOptionsWithoutSense) {
  const auto refusal = [](const JobOptions& options) {
    return testing::message_of<InvalidInput>([&] { run_jobs(options, draw_job); });
  };
  EXPECT_EQ(refusal({.count = 0}), "run_jobs: 0 jobs; at least 1 is needed");
  EXPECT_EQ(refusal({.workers = -1}), "run_jobs: -1 workers; 0 means one per core");
  EXPECT_EQ(refusal({.time_limit = testing::kNan}),
            "run_jobs: the time limit is nan s, but must be positive");
  EXPECT_EQ(refusal({.name = "two\nlines"}),
            "run_jobs: the study's name \"two\\x0alines\" must be one line of at most 60 "
            "characters");
}

TEST_F(ManyStarts, ATableThatCannotBeWrittenStopsNoJobAndIsSavedElsewhere) {
  fs::create_directory(folder_ / "out");
  JobOptions options = draw_study(folder_ / "out/table", 2);
  int done = 0;
  options.on_job = [&](int, const JobResult&) {
    if (++done == 1) {
      fs::remove_all(folder_ / "out");
    }
  };
  const fs::path before = fs::current_path();
  fs::current_path(folder_.path());
  const std::string message = testing::message_of<IoError>([&] { run_jobs(options, draw_job); });
  fs::current_path(before);
  EXPECT_EQ(message, (folder_ / "out/table").string() +
                         ": cannot be written: No such file or directory; saved as "
                         "./table.rescued instead");
  EXPECT_EQ(done, options.count);
  options.table = folder_ / "table.rescued";
  options.on_job = {};
  EXPECT_EQ(run_jobs(options, draw_job).ran, 0);
}

TEST_F(ManyStarts, ASignalToAJobIsNoResult) {
  JobOptions options = draw_study(folder_ / "table", 1);
  const JobReport report = run_jobs(options, [](int index, std::mt19937_64& random) {
    ::raise(SIGINT);  // as from a terminal, to the whole group of processes
    ::raise(SIGTERM);
    return draw_job(index, random);
  });
  for (const std::optional<JobResult>& result : report.results) {
    ASSERT_TRUE(result.has_value());
    EXPECT_FALSE(result->failed) << result->message;
  }
}

}  // namespace
}  // namespace hbar::study
