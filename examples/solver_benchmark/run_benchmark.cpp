#include "run_benchmark.h"

#include <algorithm>

#include "corpus.h"
#include "hbar/core/base/error.h"
#include "hbar/suite.h"

namespace hbar::solver_benchmark {
namespace {

using solvers::Ordering;

/// One column of the benchmark.
struct Entrant {
  std::string solver;
  Ordering ordering;
};

bool offers(const std::string& solver, Ordering ordering) {
  return solver == "auto" ? ordering == Ordering::kDefault
                          : solvers::find_solver(solver).offers(ordering);
}

/// Who is measured on a matrix of that structure.
std::vector<Entrant> entrants(const BenchmarkPlan& plan, solvers::Structure structure) {
  std::vector<std::string> names = plan.solvers;
  if (names.empty()) {
    names.emplace_back("auto");
    for (const solvers::SolverEntry& entry : solvers::available_solvers()) {
      if (entry.claims(structure)) {
        names.push_back(entry.name);
      }
    }
  }
  std::vector<Entrant> out;
  for (const std::string& name : names) {
    for (const Ordering ordering : plan.orderings) {
      if (offers(name, ordering)) {
        out.push_back({name, ordering});
      }
    }
  }
  return out;
}

MatrixResults described(const BenchmarkMatrix& matrix) {
  MatrixResults out;
  out.label = matrix.label;
  out.structure = name_of(matrix.options.structure);
  out.rows = static_cast<int>(matrix.A.rows());
  out.entries = static_cast<double>(matrix.A.nonZeros());
  return out;
}

/// Runs over the plan's matrices and solvers, and keeps count.
class Run {
 public:
  explicit Run(const BenchmarkPlan& plan)
      : plan_(plan), count_(plan.cases.size() + plan.files.size()) {
    results_.options = plan.options;
  }

  BenchmarkResults all() {
    CaseAssembler assembler(plan_.stop);
    for (const Case& which : plan_.cases) {
      one(name_of(which), [&] { return assembler.assemble(which); });
    }
    for (const std::filesystem::path& file : plan_.files) {
      one(matrix_name(file), [&] { return read_benchmark_matrix(file, plan_.structure); });
    }
    return std::move(results_);
  }

 private:
  bool stopped() {
    results_.interrupted = results_.interrupted || (plan_.stop != nullptr && *plan_.stop);
    return results_.interrupted;
  }

  void tell(const std::string& next) const {
    if (plan_.on_progress) {
      plan_.on_progress(done_, count_, next);
    }
  }

  template <typename Make>
  void one(const std::string& name, const Make& make) {
    if (stopped()) {
      return;
    }
    tell(name);
    try {
      const BenchmarkMatrix matrix = make();
      results_.matrices.push_back(described(matrix));
      measure_all(matrix, results_.matrices.back());
    } catch (const Error& error) {
      if (!stopped()) {
        results_.matrices.push_back({});
        results_.matrices.back().label.name = name;
        results_.matrices.back().failure = error.what();
      }
    }
    ++done_;
  }

  void measure_all(const BenchmarkMatrix& matrix, MatrixResults& out) {
    if (plan_.on_matrix) {
      plan_.on_matrix(matrix);
    }
    const Reference reference = find_reference(matrix);
    out.condition = reference.condition;
    for (const Entrant& entrant : entrants(plan_, matrix.options.structure)) {
      if (stopped()) {
        return;
      }
      tell(matrix.label.name + ' ' + entrant.solver);
      out.measurements.push_back(
          measure(matrix, reference, entrant.solver, entrant.ordering, plan_.options));
      if (plan_.on_measured) {
        plan_.on_measured(results_);
      }
    }
  }

  const BenchmarkPlan& plan_;
  std::size_t count_ = 0;
  std::size_t done_ = 0;
  BenchmarkResults results_;
};

}  // namespace

void check_plan(const BenchmarkPlan& plan) {
  bool any = plan.solvers.empty();
  for (const std::string& solver : plan.solvers) {
    for (const Ordering ordering : plan.orderings) {
      any = offers(solver, ordering) || any;
    }
  }
  if (!any) {
    throw InvalidInput("none of these solvers offers any of these orderings; take default");
  }
}

BenchmarkResults run_benchmark(const BenchmarkPlan& plan) {
  check_plan(plan);
  return Run(plan).all();
}

}  // namespace hbar::solver_benchmark
