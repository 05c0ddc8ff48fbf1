# Installation: headers under include/hbar/LAYER, libraries, and find_package(hbar).

set(not_built)
get_property(left_out GLOBAL PROPERTY HBAR_LEFT_OUT)
foreach(name IN LISTS left_out)
  list(APPEND not_built PATTERN ${name}.h EXCLUDE)
endforeach()
foreach(layer IN LISTS HBAR_LAYERS)
  install(DIRECTORY ${PROJECT_SOURCE_DIR}/${layer}/
          DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/hbar/${layer}
          FILES_MATCHING PATTERN "*.h" ${not_built})
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
