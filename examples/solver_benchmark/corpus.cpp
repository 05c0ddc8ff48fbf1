#include "corpus.h"

#include <algorithm>
#include <array>
#include <new>
#include <set>
#include <system_error>

#include "families.h"
#include "hbar/core/base/error.h"
#include "hbar/core/files/result_file.h"
#include "hbar/solvers/linear/accuracy.h"
#include "hbar/suite.h"
#include "matrix_market.h"
#include "measure.h"
#include "sidecar.h"

namespace hbar::solver_benchmark {
namespace {

namespace fs = std::filesystem;

/// A model of the corpus and how many steps it takes at each size.
struct Row {
  const char* source;         ///< a family's name or a scene file's without ".xml"
  std::array<int, 3> joints;  ///< of a family; 0 for a scene
  std::array<int, 3> steps;
  bool periodic = true;  ///< whether its periodic system is regular: something ties it to a place
};

constexpr std::array<Row, 15> kRows = {{
    {"chain", {3, 7, 16}, {20, 50, 50}},
    {"chain", {7, 12, 7}, {8, 30, 200}},
    {"tree", {7, 15, 31}, {8, 20, 20}},
    {"hand", {3, 7, 14}, {6, 12, 20}},
    {"pendulum", {}, {50, 300, 2000}},
    {"double_pendulum", {}, {30, 200, 1000}},
    {"arm", {}, {20, 100, 500}},
    {"finger", {}, {10, 50, 200}, false},
    {"tumbling_box", {}, {8, 40, 150}, false},
    {"rotate_box", {}, {10, 20, 60}},
    {"flip_box", {}, {10, 20, 60}},
    {"assemble", {}, {5, 20, 60}, false},
    {"swing_up", {}, {30, 200, 1000}, false},
    {"identify", {}, {20, 100, 500}, false},
    {"walker", {}, {5, 20, 60}, false},
}};

bool ends_with(const std::string& text, std::string_view end) {
  return text.size() > end.size() && text.ends_with(end);
}

/// NAME_b.mtx, or NAME_b.mtx.gz if only that is there, beside NAME.mtx.
fs::path beside(const fs::path& file, const char* end) {
  fs::path out = file.parent_path() / (matrix_name(file) + end);
  return fs::exists(out) ? out : out += ".gz";
}

/// The structure that the numbers themselves show.
solvers::Structure structure_of(const solvers::SparseMatrix& A) {
  const solvers::SparseMatrix transposed = A.transpose();
  const bool symmetric =
      A.nonZeros() == transposed.nonZeros() &&
      std::equal(A.outerIndexPtr(), A.outerIndexPtr() + A.cols() + 1, transposed.outerIndexPtr()) &&
      std::equal(A.innerIndexPtr(), A.innerIndexPtr() + A.nonZeros(), transposed.innerIndexPtr()) &&
      std::equal(A.valuePtr(), A.valuePtr() + A.nonZeros(), transposed.valuePtr());
  if (symmetric) {
    try {
      const auto solver =
          solvers::make_solver("cholmod_llt", {.structure = solvers::Structure::kDefinite}, A);
      solver->analyze(A);
      solver->factorize(A);
      return solvers::Structure::kDefinite;
    } catch (const Error&) {  // not definite, or no such solver in this build
    }
  }
  return solvers::Structure::kGeneral;
}

}  // namespace

std::string matrix_name(const fs::path& file) {
  std::string name = file.filename();
  for (const std::string_view end : {".gz", ".mtx"}) {
    if (ends_with(name, end)) {
      name.resize(name.size() - end.size());
    } else if (end == ".mtx") {
      return {};
    }
  }
  return name;
}

std::string_view name_of(CorpusSize size) {
  constexpr std::array<std::string_view, 3> kNames = {"small", "medium", "large"};
  return kNames[static_cast<std::size_t>(size)];
}

std::vector<Case> corpus_cases(CorpusSize size, const fs::path& scenes) {
  const auto k = static_cast<std::size_t>(size);
  std::vector<Case> cases;
  for (const Row& row : kRows) {
    for (const char* integrator : {"bdf1", "bdf2"}) {
      for (const SystemKind system : {SystemKind::kAdjoint, SystemKind::kPeriodic,
                                      SystemKind::kGaussNewton, SystemKind::kKkt}) {
        if (system == SystemKind::kPeriodic && !row.periodic) {
          continue;
        }
        Case which{.steps = row.steps[k], .integrator = integrator, .system = system};
        if (row.joints[k] > 0) {
          which.family = row.source;
          which.joints = row.joints[k];
        } else {
          which.scene = scenes / concat(row.source, ".xml");
        }
        cases.push_back(std::move(which));
      }
    }
  }
  return cases;
}

void write_corpus_matrix(const BenchmarkMatrix& given, const fs::path& folder) {
  BenchmarkMatrix matrix = given;
  const Reference reference = find_reference(matrix);
  if (!reference.failure.empty()) {
    const std::string message = concat(matrix.label.name, ": ", reference.failure);
    if (reference.out_of_memory) {
      throw solvers::OutOfMemory(message);
    }
    throw NumericalFailure(message);
  }
  matrix.condition = reference.condition;
  const std::string& name = matrix.label.name;
  const std::string comment = concat(name, ", written by hbar ", HBAR_VERSION);
  write_matrix(folder / (name + ".mtx"), matrix.A, comment);
  write_vector(folder / (name + "_b.mtx"), matrix.b, "right-hand side of " + comment);
  write_vector(folder / (name + "_x.mtx"), reference.x, "solution of " + comment);
  const double error =
      solvers::normwise_backward_error(matrix.A, solvers::System::kPlain, reference.x, matrix.b);
  scene::write_result_file(folder / (name + ".json"), sidecar_json(matrix, error));
}

std::vector<fs::path> find_matrix_files(const fs::path& folder) {
  std::error_code code;
  std::set<std::string> names;
  for (fs::directory_iterator at(folder, code), end; !code && at != end; at.increment(code)) {
    const std::string name = matrix_name(at->path());
    if (!name.empty()) {
      names.insert(name);
    }
  }
  if (code == std::errc::not_enough_memory) {
    throw std::bad_alloc();
  }
  if (code) {
    throw IoError(concat(folder.string(), ": cannot be read: ", code.message()));
  }
  std::vector<fs::path> files;
  for (const std::string& name : names) {
    const bool belongs = (ends_with(name, "_b") || ends_with(name, "_x")) &&
                         names.contains(name.substr(0, name.size() - 2));
    if (!belongs) {
      const fs::path plain = folder / (name + ".mtx");
      files.push_back(fs::exists(plain) ? plain : folder / (name + ".mtx.gz"));
    }
  }
  if (files.empty()) {
    throw InvalidInput(concat(folder.string(),
                              ": there is no Matrix Market file (NAME.mtx or "
                              "NAME.mtx.gz)"));
  }
  return files;
}

BenchmarkMatrix read_benchmark_matrix(const fs::path& file, const std::string& structure) {
  BenchmarkMatrix out;
  out.label.name = matrix_name(file);
  out.label.source = file.parent_path().filename().string();
  out.A = read_matrix(file);
  out.name_of_unknown = [](int i) { return concat(i + 1, " in the file"); };
  const fs::path sidecar = file.parent_path() / (out.label.name + ".json");
  const bool declared = fs::exists(sidecar) && read_sidecar(sidecar, out);
  if (!structure.empty()) {
    out.options.structure = find_structure(structure);
  } else if (!declared) {
    out.options.structure = structure_of(out.A);
  }
  const fs::path b = beside(file, "_b.mtx");
  out.b = fs::exists(b) ? read_vector(b, out.A.rows())
                        : Eigen::VectorXd(out.A * Eigen::VectorXd::Ones(out.A.cols()));
  const fs::path x = beside(file, "_x.mtx");
  if (fs::exists(x)) {
    out.x = read_vector(x, out.A.rows());
  }
  return out;
}

}  // namespace hbar::solver_benchmark
