# Finds sequential MUMPS 5 in double precision and makes the imported target
#
#   hbar_mumps::seq
#
# It is searched for under the names of Debian's packages (libdmumps_seq, libmumps_common_seq). Shared
# ones bring their stub of MPI, and orderings, along; static ones need them named here. Static
# libraries need hbarConfig.cmake to call this before it includes the exported targets; so this file
# is installed beside it.

include(FindPackageHandleStandardArgs)
find_path(HBAR_MUMPS_INCLUDE_DIR dmumps_c.h PATH_SUFFIXES mumps_seq mumps)
find_library(HBAR_MUMPS_LIBRARY dmumps_seq)
find_library(HBAR_MUMPS_COMMON_LIBRARY mumps_common_seq)
mark_as_advanced(HBAR_MUMPS_INCLUDE_DIR HBAR_MUMPS_LIBRARY HBAR_MUMPS_COMMON_LIBRARY)
find_package_handle_standard_args(HbarMumps
  REQUIRED_VARS HBAR_MUMPS_LIBRARY HBAR_MUMPS_COMMON_LIBRARY HBAR_MUMPS_INCLUDE_DIR
  REASON_FAILURE_MESSAGE "on Debian and Ubuntu: apt-get install libmumps-seq-dev")

if(HbarMumps_FOUND AND NOT TARGET hbar_mumps::seq)
  add_library(hbar_mumps::seq UNKNOWN IMPORTED)
  set_target_properties(hbar_mumps::seq PROPERTIES
    IMPORTED_LOCATION ${HBAR_MUMPS_LIBRARY}
    INTERFACE_INCLUDE_DIRECTORIES ${HBAR_MUMPS_INCLUDE_DIR}
    INTERFACE_LINK_LIBRARIES ${HBAR_MUMPS_COMMON_LIBRARY})
  if(HBAR_MUMPS_LIBRARY MATCHES "\\.a$")
    foreach(_need pord_seq mpiseq_seq lapack blas metis scotch scotcherr gfortran pthread)
      find_library(HBAR_MUMPS_${_need}_LIBRARY ${_need})
      mark_as_advanced(HBAR_MUMPS_${_need}_LIBRARY)
      if(HBAR_MUMPS_${_need}_LIBRARY)
        set_property(TARGET hbar_mumps::seq APPEND PROPERTY
                     INTERFACE_LINK_LIBRARIES ${HBAR_MUMPS_${_need}_LIBRARY})
      endif()
    endforeach()
  endif()
endif()
