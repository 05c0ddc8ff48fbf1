#include "hbar/solvers/linear/solver_options.h"

#include <algorithm>
#include <array>

#include "hbar/core/base/error.h"

namespace hbar::solvers {
namespace {

constexpr std::array<std::string_view, 5> kStructures = {"general", "block_triangular", "periodic",
                                                         "definite", "quasi_definite"};
constexpr std::array<std::string_view, 6> kOrderings = {"default", "natural", "amd",
                                                        "colamd",  "metis",   "nested"};

}  // namespace

std::string_view name_of(Structure structure) {
  return kStructures[static_cast<std::size_t>(structure)];
}

std::string_view name_of(Ordering ordering) {
  return kOrderings[static_cast<std::size_t>(ordering)];
}

Ordering find_ordering(std::string_view name) {
  const auto place = std::find(kOrderings.begin(), kOrderings.end(), name);
  if (place == kOrderings.end()) {
    std::string known;
    for (const std::string_view ordering : kOrderings) {
      known += concat(' ', ordering);
    }
    throw InvalidInput(concat("there is no ordering \"", name, "\"; known:", known));
  }
  return static_cast<Ordering>(place - kOrderings.begin());
}

void refuse_other_orderings(std::string_view solver, Ordering ordering,
                            std::initializer_list<Ordering> offered) {
  if (std::find(offered.begin(), offered.end(), ordering) != offered.end()) {
    return;
  }
  std::string names;
  for (const Ordering known : offered) {
    names += concat(names.empty() ? "" : ", ", name_of(known));
  }
  throw InvalidInput(concat(solver, ": the ordering \"", name_of(ordering),
                            "\" is not offered; offered: ", names));
}

}  // namespace hbar::solvers
