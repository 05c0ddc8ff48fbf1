# Finds NLopt 2.6 or newer and makes the imported target
#
#   hbar_nlopt_library::nlopt
#
# Only its C interface is called. Hints: pkg-config's nlopt.pc, CMAKE_PREFIX_PATH. Static libraries
# need hbarConfig.cmake to call this before it includes the exported targets; so this file is
# installed beside it.

include(FindPackageHandleStandardArgs)
find_package(PkgConfig QUIET)
if(PkgConfig_FOUND)
  pkg_check_modules(HBAR_NLOPT_PC QUIET nlopt>=2.6)
endif()
find_path(HBAR_NLOPT_INCLUDE_DIR nlopt.h HINTS ${HBAR_NLOPT_PC_INCLUDE_DIRS})
find_library(HBAR_NLOPT_LIBRARY nlopt HINTS ${HBAR_NLOPT_PC_LIBRARY_DIRS})
mark_as_advanced(HBAR_NLOPT_INCLUDE_DIR HBAR_NLOPT_LIBRARY)
find_package_handle_standard_args(HbarNlopt
  REQUIRED_VARS HBAR_NLOPT_LIBRARY HBAR_NLOPT_INCLUDE_DIR
  VERSION_VAR HBAR_NLOPT_PC_VERSION
  REASON_FAILURE_MESSAGE "on Debian and Ubuntu: apt-get install libnlopt-dev")

if(HbarNlopt_FOUND AND NOT TARGET hbar_nlopt_library::nlopt)
  add_library(hbar_nlopt_library::nlopt UNKNOWN IMPORTED)
  set_target_properties(hbar_nlopt_library::nlopt PROPERTIES
    IMPORTED_LOCATION ${HBAR_NLOPT_LIBRARY}
    INTERFACE_INCLUDE_DIRECTORIES ${HBAR_NLOPT_INCLUDE_DIR}
    INTERFACE_LINK_LIBRARIES m)
endif()
