// What libFuzzer, or replay.cpp, calls for each input of a target.

#include <cstdint>
#include <cstdlib>
#include <exception>
#include <iostream>

#include "hbar/core/base/error.h"
#include "tests/fuzz/target.h"

namespace hbar::fuzz {

void fail(const std::string& what) {
  std::cerr << "finding: " << what << std::endl;
  std::abort();
}

}  // namespace hbar::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using hbar::fuzz::fail;
  try {
    hbar::fuzz::try_input({reinterpret_cast<const char*>(data), size});
  } catch (const hbar::Error& error) {
    hbar::fuzz::require(*error.what() != '\0', "an error without a message");
  } catch (const std::exception& error) {
    fail(std::string("an exception that is no hbar::Error: ") + error.what());
  }
  return 0;
}
