#include "hbar/adjoint/programs/formulation.h"

#include <array>
#include <string>
#include <utility>

#include "hbar/core/base/error.h"
#include "hbar/core/base/nearest_name.h"

namespace hbar {
namespace {

constexpr std::array<std::pair<Formulation, std::string_view>, 3> kFormulations = {
    {{Formulation::kShooting, "shooting"},
     {Formulation::kMultipleShooting, "multiple-shooting"},
     {Formulation::kAllAtOnce, "all-at-once"}}};

}  // namespace

std::string_view name_of(Formulation formulation) {
  return kFormulations[static_cast<std::size_t>(formulation)].second;
}

Formulation find_formulation(std::string_view name) {
  std::vector<std::string> known;
  for (const auto& [formulation, its_name] : kFormulations) {
    if (name == its_name) {
      return formulation;
    }
    known.emplace_back(its_name);
  }
  throw InvalidInput(concat("there is no formulation '", name, "'; ",
                            unknown_name_hint(std::string(name), known)));
}

std::vector<int> segment_starts(int steps, int segments) {
  if (segments < 1 || segments > steps) {
    throw InvalidInput(concat("multiple shooting: ", segments, " segments of ", steps,
                              " steps; there must be at least one, and no more than steps"));
  }
  std::vector<int> out;
  for (int i = 1; i < segments; ++i) {
    out.push_back(static_cast<int>(static_cast<long long>(steps) * i / segments));
  }
  return out;
}

}  // namespace hbar
