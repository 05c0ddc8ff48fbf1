// An OBJ file: its faces, the solid that they bound, and its distance grid.

#include "hbar/core/scene/read_obj.h"
#include "tests/fuzz/solid.h"

void hbar::fuzz::try_input(std::string_view input) {
  try_solid(scene::read_obj_text(input, "mesh.obj"), "mesh.obj");
}
