#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "hbar/adjoint/systems/trajectory_system.h"

namespace hbar::solver_benchmark {

/// What a matrix is assembled from: a motion of a generated or a read model, and one of its
/// systems.
struct Case {
  std::string family = {};           ///< a name of families(); empty for a scene
  int joints = 0;                    ///< of the family's mechanism
  std::filesystem::path scene = {};  ///< a scene file; empty for a family
  int steps = 100;
  std::string integrator = "bdf2";
  SystemKind system = SystemKind::kAdjoint;
};

/// "chain7", or a scene file's name without folder and ending.
[[nodiscard]] std::string source_name(const Case& which);

/// "chain7_bdf2_100_adjoint": a name that can be a file's.
[[nodiscard]] std::string name_of(const Case& which);

/// Where a matrix comes from. What is not known is empty or 0.
struct MatrixLabel {
  std::string name;        ///< of the case, or of the file without its ending
  std::string source;      ///< source_name, or the folder of the file
  std::string family;      ///< a name of families(), or empty
  std::string system;      ///< "adjoint", …
  std::string integrator;  ///< "bdf1", …
  int dof = 0;             ///< n, coordinates of the model
  int steps = 0;           ///< T
  double h = 0.0;          ///< time step, s
};

/// A linear system A x = b with what is known about it.
struct BenchmarkMatrix {
  MatrixLabel label;
  solvers::SparseMatrix A;                          ///<                            [m x m]
  Eigen::VectorXd b;                                ///<                            [m]
  solvers::SolverOptions options;                   ///< structure and blocks
  std::function<std::string(int)> name_of_unknown;  ///< for messages; may be empty
  std::optional<Eigen::VectorXd> x;                 ///< a solution that came with it [m]
  std::optional<double> condition;                  ///< an estimate that came with it
};

/// Simulates and assembles. Cases that differ in their system alone share one simulation if they
/// are requested one after the other. Belongs to one thread at a time.
class CaseAssembler {
 public:
  /// @param stop  ends a simulation early; may be null
  explicit CaseAssembler(const std::atomic<bool>* stop = nullptr);
  ~CaseAssembler();

  /// @throws InvalidInput, IoError for an invalid scene or number of joints, and for a system that
  ///         the motion does not have
  /// @throws NumericalFailure if the simulation stops
  [[nodiscard]] BenchmarkMatrix assemble(const Case& which);

 private:
  struct Motion;
  Motion& motion_of(const Case& which);

  const std::atomic<bool>* stop_;
  std::unique_ptr<Motion> motion_;
};

}  // namespace hbar::solver_benchmark
