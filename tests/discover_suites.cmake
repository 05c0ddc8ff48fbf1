# Writes one test of ctest per suite of a GoogleTest program: a process for each single test would
# cost more than the tests themselves.
#
#   cmake -DPROGRAM=FILE -DOUTPUT=FILE -P discover_suites.cmake
execute_process(COMMAND ${PROGRAM} --gtest_list_tests OUTPUT_VARIABLE list RESULT_VARIABLE result)
if(result)
  message(FATAL_ERROR "${PROGRAM} --gtest_list_tests ended with ${result}")
endif()
string(REGEX MATCHALL "(^|\n)[A-Za-z0-9_/]+\\.[ \n]" suites "${list}")
set(text "")
foreach(suite IN LISTS suites)
  string(REGEX REPLACE "[ .\n]" "" suite "${suite}")
  string(APPEND text "add_test(\"${suite}\" \"${PROGRAM}\" \"--gtest_filter=${suite}.*\")\n"
                     "set_tests_properties(\"${suite}\" PROPERTIES TIMEOUT 1500)\n")
endforeach()
file(WRITE ${OUTPUT} "${text}")
