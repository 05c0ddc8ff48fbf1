# Installation: libraries, find_package(hbar), and under include/hbar the headers that users include
# with all that these include. Other headers are not installed.

# hbar_closure(OUT HEADERS...): the headers, and those of the layers that they include.
function(hbar_closure out)
  set(found)
  set(waiting ${ARGN})
  while(waiting)
    list(POP_FRONT waiting header)
    if(NOT header IN_LIST found)
      list(APPEND found ${header})
      set_property(DIRECTORY ${PROJECT_SOURCE_DIR} APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS
                   ${PROJECT_SOURCE_DIR}/${header})
      file(STRINGS ${PROJECT_SOURCE_DIR}/${header} lines REGEX "^#include \"hbar/")
      foreach(line IN LISTS lines)
        string(REGEX REPLACE "^#include \"hbar/(.*)\".*" "\\1" included ${line})
        list(APPEND waiting ${included})
      endforeach()
    endif()
  endwhile()
  set(${out} ${found} PARENT_SCOPE)
endfunction()

set(users ${HBAR_USER_HEADERS})
foreach(component IN LISTS HBAR_OPTIONAL_COMPONENTS)
  if(NOT TARGET hbar_${component})
    list(FILTER users EXCLUDE REGEX "/${component}\\.h$")
    # Including its header reports what is missing.
    set(HBAR_MISSING ${component})
    set(HBAR_MISSING_NEEDS ${HBAR_NEEDS_${component}})
    configure_file(${PROJECT_SOURCE_DIR}/cmake/missing_component.h.in
                   ${PROJECT_BINARY_DIR}/missing/${component}.h)
    install(FILES ${PROJECT_BINARY_DIR}/missing/${component}.h
            DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/hbar)
  endif()
endforeach()
hbar_closure(headers ${users})
foreach(header IN LISTS headers)
  get_filename_component(folder ${header} DIRECTORY)
  if(header IN_LIST users)
    set(folder)
  endif()
  install(FILES ${PROJECT_SOURCE_DIR}/${header}
          DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/hbar/${folder})
endforeach()

set(HBAR_CONFIG_DIR ${CMAKE_INSTALL_LIBDIR}/cmake/hbar)
install(EXPORT hbarTargets NAMESPACE hbar:: DESTINATION ${HBAR_CONFIG_DIR})
foreach(component IN LISTS HBAR_OPTIONAL_COMPONENTS)
  if(TARGET hbar_${component})
    install(EXPORT hbar_${component}Targets NAMESPACE hbar:: DESTINATION ${HBAR_CONFIG_DIR})
  endif()
endforeach()

configure_package_config_file(${PROJECT_SOURCE_DIR}/cmake/hbarConfig.cmake.in
                              ${PROJECT_BINARY_DIR}/hbarConfig.cmake
                              INSTALL_DESTINATION ${HBAR_CONFIG_DIR}
                              NO_SET_AND_CHECK_MACRO)
write_basic_package_version_file(${PROJECT_BINARY_DIR}/hbarConfigVersion.cmake
                                 COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/hbarConfig.cmake ${PROJECT_BINARY_DIR}/hbarConfigVersion.cmake
        ${PROJECT_SOURCE_DIR}/cmake/FindSuiteSparse.cmake
        ${PROJECT_SOURCE_DIR}/cmake/FindHbarIpopt.cmake
        ${PROJECT_SOURCE_DIR}/cmake/FindHbarMumps.cmake
        ${PROJECT_SOURCE_DIR}/cmake/FindHbarNlopt.cmake
        DESTINATION ${HBAR_CONFIG_DIR})
