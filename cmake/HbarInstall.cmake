# Installation: headers under include/hbar/FLOOR, libraries, and find_package(hbar).

foreach(floor core scene solvers adjoint)
  install(DIRECTORY ${CMAKE_CURRENT_SOURCE_DIR}/${floor}/
          DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/hbar/${floor}
          FILES_MATCHING PATTERN "*.h")
endforeach()
