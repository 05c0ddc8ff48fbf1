// An STL file, ASCII or binary: its facets, the solid that they bound, and its distance grid.

#include "hbar/core/scene/read_stl.h"
#include "tests/fuzz/solid.h"

void hbar::fuzz::try_input(std::string_view input) {
  try_solid(scene::read_stl_bytes(input, "mesh.stl"), "mesh.stl");
}
