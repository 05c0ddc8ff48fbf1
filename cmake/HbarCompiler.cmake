# Compiler settings shared by every layer, and the functions that declare a layer.

if(NOT CMAKE_BUILD_TYPE AND NOT CMAKE_CONFIGURATION_TYPES)
  set(CMAKE_BUILD_TYPE Release CACHE STRING "Build type" FORCE)
endif()

add_library(hbar_flags INTERFACE)
target_compile_features(hbar_flags INTERFACE cxx_std_20)
target_compile_options(hbar_flags INTERFACE
  -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wold-style-cast -Wnon-virtual-dtor
  -Woverloaded-virtual -Wnull-dereference
  $<$<BOOL:${HBAR_WARNINGS_AS_ERRORS}>:-Werror>)
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
  # GCC 12 reports false positives of these inside Eigen and std::string at -O2 and above.
  target_compile_options(hbar_flags INTERFACE -Wno-maybe-uninitialized -Wno-array-bounds
                         -Wno-null-dereference -Wno-stringop-overflow -Wno-restrict)
endif()
if(HBAR_SANITIZE)
  add_compile_options(-fsanitize=${HBAR_SANITIZE} -fno-omit-frame-pointer
                      -fno-sanitize-recover=all)
  add_link_options(-fsanitize=${HBAR_SANITIZE})
endif()
if(HBAR_BUILD_FUZZERS)
  if(NOT CMAKE_CXX_COMPILER_ID MATCHES "Clang")
    message(FATAL_ERROR "HBAR_BUILD_FUZZERS is ON and the compiler is ${CMAKE_CXX_COMPILER_ID}: libFuzzer "
                        "comes with clang (cmake --preset fuzz, or -DCMAKE_CXX_COMPILER=clang++)")
  endif()
  include(CheckCXXSourceCompiles)
  set(CMAKE_REQUIRED_FLAGS -fsanitize=fuzzer)
  check_cxx_source_compiles(
    "extern \"C\" int LLVMFuzzerTestOneInput(const unsigned char*, decltype(sizeof 0)) { return 0; }"
    HBAR_HAVE_LIBFUZZER)
  unset(CMAKE_REQUIRED_FLAGS)
  if(NOT HBAR_HAVE_LIBFUZZER)
    message(FATAL_ERROR "HBAR_BUILD_FUZZERS is ON and clang has no libFuzzer (Debian 12: apt-get "
                        "install libclang-rt-14-dev)")
  endif()
  # What libFuzzer learns from: which branches of the code an input takes.
  add_compile_options(-fsanitize=fuzzer-no-link)
  add_link_options(-fsanitize=fuzzer-no-link)
endif()

# HBAR_ARCH applies only where this machine can run the result: a build for another machine
# says so with CMAKE_CROSSCOMPILING and is taken at its word.
if(HBAR_ARCH)
  include(CheckCXXSourceRuns)
  set(CMAKE_REQUIRED_FLAGS "-march=${HBAR_ARCH} -O2")
  check_cxx_source_runs(
    "#include <cstdlib>
     int main(int argc, char** argv) {
       double s = 0.0, a[16];
       for (int i = 0; i < 16; ++i) a[i] = argc + std::atoi(argv[0]) + i;
       for (int i = 0; i < 16; ++i) s += a[i] * a[i];
       return s > 0.0 ? 0 : 1;
     }" HBAR_ARCH_RUNS)
  unset(CMAKE_REQUIRED_FLAGS)
  if(HBAR_ARCH_RUNS OR CMAKE_CROSSCOMPILING)
    target_compile_options(hbar_flags INTERFACE -march=${HBAR_ARCH})
  else()
    message(STATUS "hbar: this machine does not run -march=${HBAR_ARCH}; building for the default")
  endif()
endif()

# Shared libraries find each other, and a program finds them, wherever they are installed.
if(BUILD_SHARED_LIBS)
  set(CMAKE_INSTALL_RPATH "$ORIGIN" "$ORIGIN/../${CMAKE_INSTALL_LIBDIR}")
endif()

# The headers of every layer are reached as "hbar/LAYER/folder/file.h", through one include directory.
set(HBAR_INCLUDE_DIR ${CMAKE_BINARY_DIR}/include)
file(MAKE_DIRECTORY ${HBAR_INCLUDE_DIR}/hbar)
set(HBAR_LAYERS core contact solvers adjoint)
foreach(layer IN LISTS HBAR_LAYERS)
  file(CREATE_LINK ${CMAKE_CURRENT_SOURCE_DIR}/${layer} ${HBAR_INCLUDE_DIR}/hbar/${layer} SYMBOLIC)
endforeach()

# What users include: all that needs no component, then a header per component, as "hbar/name.h".
set(HBAR_USER_HEADERS adjoint/hbar.h adjoint/study.h solvers/ipopt.h solvers/nlopt.h solvers/suite.h
    solvers/umfpack.h)
foreach(header IN LISTS HBAR_USER_HEADERS)
  get_filename_component(name ${header} NAME)
  file(CREATE_LINK ${CMAKE_CURRENT_SOURCE_DIR}/${header} ${HBAR_INCLUDE_DIR}/hbar/${name} SYMBOLIC)
endforeach()

# An optional part has an export set of its own: who does without it needs none of its dependencies.
# One that uses another comes after it.
set(HBAR_OPTIONAL_COMPONENTS umfpack ipopt nlopt suite study)
# What a build without one says is needed for it.
set(HBAR_NEEDS_umfpack "libsuitesparse-dev and -DHBAR_WITH_UMFPACK=ON")
set(HBAR_NEEDS_ipopt "coinor-libipopt-dev, pkg-config and -DHBAR_WITH_IPOPT=ON")
set(HBAR_NEEDS_nlopt "libnlopt-dev and -DHBAR_WITH_NLOPT=ON")
set(HBAR_NEEDS_suite "-DHBAR_WITH_SUITE=ON")
set(HBAR_NEEDS_study "hbar::ipopt: ${HBAR_NEEDS_ipopt}")

# hbar_leave_out(NAMES...): what this build goes without. Tests NAME*_test.cpp are not compiled; a
# component NAME is not there, and its header says so.
function(hbar_leave_out)
  set_property(GLOBAL APPEND PROPERTY HBAR_LEFT_OUT ${ARGN})
endfunction()

function(hbar_install_target target)
  set(export hbarTargets)
  foreach(component IN LISTS HBAR_OPTIONAL_COMPONENTS)
    if(target STREQUAL hbar_${component})
      set(export ${target}Targets)
    endif()
  endforeach()
  install(TARGETS ${target} EXPORT ${export}
          ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR}
          LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR}
          RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
endfunction()

# hbar_compile_in_batches(TARGETS...): headers and templates are compiled once for several files, if
# HBAR_UNITY asks for it; then the files of a target share their unnamed namespace. A batch needs up
# to 2 GB of memory, so that GCC need not look for unused memory below that: an eighth of its time.
function(hbar_compile_in_batches)
  set_target_properties(${ARGN} PROPERTIES UNITY_BUILD ${HBAR_UNITY} UNITY_BUILD_BATCH_SIZE 16)
  if(HBAR_UNITY AND CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
    foreach(target IN LISTS ARGN)
      target_compile_options(${target} PRIVATE --param=ggc-min-heapsize=1500000)
    endforeach()
  endif()
endfunction()

# hbar_add_layer(NAME SOURCES...): a library hbar_NAME, exported as hbar::NAME.
function(hbar_add_layer name)
  add_library(hbar_${name} ${ARGN})
  add_library(hbar::${name} ALIAS hbar_${name})
  set_target_properties(hbar_${name} PROPERTIES EXPORT_NAME ${name}
                        POSITION_INDEPENDENT_CODE ON VERSION ${PROJECT_VERSION}
                        SOVERSION ${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR})
  target_compile_features(hbar_${name} PUBLIC cxx_std_20)
  # One alignment and one way to allocate, resize and free memory on both sides of the interface,
  # whatever -march each was built with. Eigen takes the largest vector of the machine that it is
  # compiled for, unless it is told more than any has.
  target_compile_definitions(hbar_${name} PUBLIC
    EIGEN_MAX_ALIGN_BYTES=64 EIGEN_MAX_STATIC_ALIGN_BYTES=16 EIGEN_MALLOC_ALREADY_ALIGNED=0)
  target_include_directories(hbar_${name} PUBLIC
    $<BUILD_INTERFACE:${HBAR_INCLUDE_DIR}> $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
  target_link_libraries(hbar_${name} PRIVATE $<BUILD_INTERFACE:hbar_flags>)
  hbar_compile_in_batches(hbar_${name})
  # Eigen takes a third of most files' compilation; it is read once.
  if(HBAR_PRECOMPILE_HEADERS)
    if(name STREQUAL "core")
      target_precompile_headers(hbar_core PRIVATE <Eigen/Dense> <functional> <memory> <string>
                                <variant> <vector>)
    else()
      target_precompile_headers(hbar_${name} REUSE_FROM hbar_core)
    endif()
  endif()
  hbar_install_target(hbar_${name})
endfunction()
