# Finds Ipopt 3.11 or newer through pkg-config and makes the imported target
#
#   hbar_coin::Ipopt
#
# with Ipopt's headers (coin/ before 3.14, coin-or/ since) and its compile flags, linking libipopt
# alone: the .pc file of a shared Ipopt also lists MUMPS and LAPACK, which hbar does not call. Static
# libraries need hbarConfig.cmake to call this before it includes the exported targets; so this
# file is installed beside it.

include(FindPackageHandleStandardArgs)
find_package(PkgConfig QUIET)
if(PkgConfig_FOUND)
  pkg_check_modules(HBAR_IPOPT_PC QUIET ipopt>=3.11)
endif()
find_path(HBAR_IPOPT_INCLUDE_DIR IpTNLP.hpp
          HINTS ${HBAR_IPOPT_PC_INCLUDE_DIRS} PATH_SUFFIXES coin-or coin)
find_library(HBAR_IPOPT_LIBRARY ipopt HINTS ${HBAR_IPOPT_PC_LIBRARY_DIRS})
mark_as_advanced(HBAR_IPOPT_INCLUDE_DIR HBAR_IPOPT_LIBRARY)
find_package_handle_standard_args(HbarIpopt
  REQUIRED_VARS HBAR_IPOPT_LIBRARY HBAR_IPOPT_INCLUDE_DIR
  VERSION_VAR HBAR_IPOPT_PC_VERSION
  REASON_FAILURE_MESSAGE "on Debian and Ubuntu: apt-get install coinor-libipopt-dev pkg-config")

if(HbarIpopt_FOUND AND NOT TARGET hbar_coin::Ipopt)
  add_library(hbar_coin::Ipopt UNKNOWN IMPORTED)
  # 3.11's headers need HAVE_CSTDDEF, which newer ones ignore.
  set_target_properties(hbar_coin::Ipopt PROPERTIES
    IMPORTED_LOCATION ${HBAR_IPOPT_LIBRARY}
    INTERFACE_INCLUDE_DIRECTORIES ${HBAR_IPOPT_INCLUDE_DIR}
    INTERFACE_COMPILE_DEFINITIONS HAVE_CSTDDEF)
endif()
