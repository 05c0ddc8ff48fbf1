# Finds the parts of SuiteSparse that hbar uses, 5.x (which ships no CMake files) and 7.x alike.
#
#   find_package(SuiteSparse REQUIRED COMPONENTS KLU OPTIONAL_COMPONENTS UMFPACK)
#
# Components: KLU, UMFPACK, CHOLMOD, SPQR. Each one found becomes an imported target
#
#   hbar_suitesparse::KLU    hbar_suitesparse::UMFPACK    and so on
#
# (names of our own: SuiteSparse 7 defines SuiteSparse::KLU itself), and sets
# SuiteSparse_<component>_FOUND. Static libraries need hbarConfig.cmake to call this with the same
# components before it includes the exported targets; so this file is installed beside it.
# Hints: SuiteSparse_ROOT, CMAKE_PREFIX_PATH.

include(FindPackageHandleStandardArgs)

set(_hbar_suitesparse_header_KLU klu.h)
set(_hbar_suitesparse_header_UMFPACK umfpack.h)
set(_hbar_suitesparse_header_CHOLMOD cholmod.h)
set(_hbar_suitesparse_header_SPQR SuiteSparseQR.hpp)
# What each part itself calls, needed where the libraries are static ones.
set(_hbar_suitesparse_needs_KLU btf amd colamd suitesparseconfig)
set(_hbar_suitesparse_needs_UMFPACK amd cholmod suitesparseconfig)
set(_hbar_suitesparse_needs_CHOLMOD amd colamd camd ccolamd suitesparseconfig metis lapack blas)
set(_hbar_suitesparse_needs_SPQR cholmod ${_hbar_suitesparse_needs_CHOLMOD})

if(NOT SuiteSparse_FIND_COMPONENTS)
  set(SuiteSparse_FIND_COMPONENTS KLU UMFPACK CHOLMOD SPQR)
endif()

set(_hbar_suitesparse_required)
foreach(_part IN LISTS SuiteSparse_FIND_COMPONENTS)
  if(NOT DEFINED _hbar_suitesparse_header_${_part})
    message(FATAL_ERROR "FindSuiteSparse: unknown component ${_part}; "
                        "known: KLU, UMFPACK, CHOLMOD, SPQR")
  endif()
  string(TOLOWER ${_part} _library)
  find_path(SuiteSparse_${_part}_INCLUDE_DIR ${_hbar_suitesparse_header_${_part}}
            PATH_SUFFIXES suitesparse)
  find_library(SuiteSparse_${_part}_LIBRARY ${_library})
  mark_as_advanced(SuiteSparse_${_part}_INCLUDE_DIR SuiteSparse_${_part}_LIBRARY)
  if(SuiteSparse_${_part}_INCLUDE_DIR AND SuiteSparse_${_part}_LIBRARY)
    set(SuiteSparse_${_part}_FOUND TRUE)
  else()
    set(SuiteSparse_${_part}_FOUND FALSE)
  endif()
  if(SuiteSparse_FIND_REQUIRED_${_part})
    list(APPEND _hbar_suitesparse_required
         SuiteSparse_${_part}_LIBRARY SuiteSparse_${_part}_INCLUDE_DIR)
  endif()
  if(SuiteSparse_${_part}_FOUND AND NOT TARGET hbar_suitesparse::${_part})
    add_library(hbar_suitesparse::${_part} UNKNOWN IMPORTED)
    set_target_properties(hbar_suitesparse::${_part} PROPERTIES
      IMPORTED_LOCATION ${SuiteSparse_${_part}_LIBRARY}
      INTERFACE_INCLUDE_DIRECTORIES ${SuiteSparse_${_part}_INCLUDE_DIR})
    if(SuiteSparse_${_part}_LIBRARY MATCHES "\\.a$")
      foreach(_need IN LISTS _hbar_suitesparse_needs_${_part})
        find_library(SuiteSparse_${_need}_LIBRARY ${_need})
        mark_as_advanced(SuiteSparse_${_need}_LIBRARY)
        if(SuiteSparse_${_need}_LIBRARY)
          set_property(TARGET hbar_suitesparse::${_part} APPEND PROPERTY
                       INTERFACE_LINK_LIBRARIES ${SuiteSparse_${_need}_LIBRARY})
        endif()
      endforeach()
    endif()
  endif()
endforeach()

find_package_handle_standard_args(SuiteSparse
  REQUIRED_VARS ${_hbar_suitesparse_required} HANDLE_COMPONENTS
  REASON_FAILURE_MESSAGE "on Debian and Ubuntu: apt-get install libsuitesparse-dev")
