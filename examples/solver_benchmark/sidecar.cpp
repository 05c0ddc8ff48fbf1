#include "sidecar.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <nlohmann/json.hpp>

#include "hbar/core/base/error.h"
#include "hbar/core/base/nearest_name.h"
#include "hbar/core/files/numbers.h"
#include "hbar/core/files/text_file.h"

namespace hbar::solver_benchmark {
namespace {

using Json = nlohmann::ordered_json;
using solvers::Structure;

constexpr std::array kStructures = {Structure::kGeneral, Structure::kBlockTriangular,
                                    Structure::kPeriodic, Structure::kDefinite,
                                    Structure::kQuasiDefinite};

// Those that are read, then those that only tell.
const std::vector<std::string> kKeys = {
    "source",    "family", "system", "integrator", "n",
    "T",         "h",      "rows",   "blocks",     "condition",
    "structure", "hbar",   "name",   "entries",    "solution_backward_error"};

/// Block sizes as runs of (how many, of what size): most are equal.
Json runs(const std::vector<int>& sizes) {
  Json out = Json::array();
  for (const int size : sizes) {
    if (out.empty() || out.back()[1] != size) {
      out.push_back({0, size});
    }
    out.back()[0] = out.back()[0].get<int>() + 1;
  }
  return out;
}

/// A number that is an int already: JSON's own conversion would make one of any number.
int whole_number(const Json& number, std::string_view what) {
  constexpr std::uint64_t kLargest = std::numeric_limits<int>::max();
  if (!number.is_number_unsigned() || number.get<std::uint64_t>() > kLargest) {
    throw InvalidInput(concat(what, " is ", scene::quotable(number.dump()),
                              "; it is a whole number from 0 to ", kLargest));
  }
  return number.get<int>();
}

/// Block sizes from runs; nothing is made of more blocks than the matrix has rows.
std::vector<int> sizes(const Json& runs_of_blocks, Eigen::Index rows) {
  std::vector<int> out;
  Eigen::Index left = rows;
  for (const Json& run : runs_of_blocks) {
    const int count = whole_number(run.at(0), "blocks: a count");
    const int size = whole_number(run.at(1), "blocks: a size");
    if (count < 1 || size < 1) {
      throw InvalidInput("blocks: counts and sizes are at least 1");
    }
    left -= Eigen::Index{count} * size;
    if (left < 0) {
      break;
    }
    out.insert(out.end(), static_cast<std::size_t>(count), size);
  }
  if (left != 0 && !runs_of_blocks.empty()) {
    throw InvalidInput(concat("blocks are not those of a matrix of ", rows, " rows"));
  }
  return out;
}

/// Sets all that is there; returns whether the structure is.
bool set(const Json& json, BenchmarkMatrix& matrix) {
  if (!json.is_object()) {
    throw InvalidInput("this is no JSON object");
  }
  for (const auto& [key, value] : json.items()) {
    if (std::find(kKeys.begin(), kKeys.end(), key) == kKeys.end()) {
      throw InvalidInput(concat("there is no key \"", scene::quotable(key), "\"; ",
                                unknown_name_hint(key, kKeys)));
    }
  }
  MatrixLabel& label = matrix.label;
  label.source = json.value("source", label.source);
  label.family = json.value("family", label.family);
  label.system = json.value("system", label.system);
  label.integrator = json.value("integrator", label.integrator);
  label.dof = json.contains("n") ? whole_number(json["n"], "n") : label.dof;
  label.steps = json.contains("T") ? whole_number(json["T"], "T") : label.steps;
  label.h = json.value("h", label.h);
  if (json.contains("rows") && json["rows"] != matrix.A.rows()) {
    throw InvalidInput(concat("rows is ", scene::quotable(json["rows"].dump()), "; the matrix has ",
                              matrix.A.rows(), " rows"));
  }
  if (json.contains("blocks")) {
    matrix.options.block_sizes = sizes(json["blocks"], matrix.A.rows());
  }
  if (json.contains("condition") && json["condition"].is_number()) {
    matrix.condition = json["condition"].get<double>();
  }
  if (!json.contains("structure")) {
    return false;
  }
  matrix.options.structure = find_structure(json["structure"].get<std::string>());
  return true;
}

}  // namespace

std::vector<std::string> structure_names() {
  std::vector<std::string> out;
  for (const Structure structure : kStructures) {
    out.emplace_back(name_of(structure));
  }
  return out;
}

Structure find_structure(const std::string& name) {
  for (const Structure structure : kStructures) {
    if (name_of(structure) == name) {
      return structure;
    }
  }
  throw InvalidInput(concat("there is no structure \"", scene::quotable(name), "\"; ",
                            unknown_name_hint(name, structure_names())));
}

std::string sidecar_json(const BenchmarkMatrix& matrix, double backward_error) {
  const MatrixLabel& label = matrix.label;
  const Json out = {{"hbar", HBAR_VERSION},
                    {"name", label.name},
                    {"source", label.source},
                    {"family", label.family},
                    {"n", label.dof},
                    {"T", label.steps},
                    {"h", label.h},
                    {"integrator", label.integrator},
                    {"system", label.system},
                    {"structure", std::string(name_of(matrix.options.structure))},
                    {"blocks", runs(matrix.options.block_sizes)},
                    {"rows", matrix.A.rows()},
                    {"entries", matrix.A.nonZeros()},
                    {"condition", matrix.condition ? Json(*matrix.condition) : Json()},
                    {"solution_backward_error", backward_error}};
  return out.dump(1, ' ', false, Json::error_handler_t::replace) + '\n';
}

bool read_sidecar(const std::filesystem::path& file, BenchmarkMatrix& matrix) {
  try {
    return set(Json::parse(scene::read_text_file(file)), matrix);
  } catch (const Json::exception& error) {
    throw InvalidInput(concat(file.string(), ": not what `hbar corpus` writes: ", error.what()));
  } catch (const InvalidInput& error) {
    throw InvalidInput(concat(file.string(), ": ", error.what()));
  }
}

}  // namespace hbar::solver_benchmark
