# cmake -DPROGRAM=... -DLABEL=... -DOUTPUT=... -P ListSuites.cmake: writes what ctest includes, one test for each suite of
# a GoogleTest program. The tests of a suite share a process, since a driver compiles pipelines anew in each: for most
# tests of pictures that takes longer than the pictures do.
execute_process(COMMAND ${PROGRAM} --gtest_list_tests OUTPUT_VARIABLE listed COMMAND_ERROR_IS_FATAL ANY)
string(REGEX MATCHALL "(^|\n)[A-Za-z0-9_/]+[.]" suites "${listed}")
set(tests "")
foreach(suite IN LISTS suites)
    string(REGEX REPLACE "[\n.]" "" suite "${suite}")
    string(APPEND tests "add_test([=[${LABEL}.${suite}]=] [=[${PROGRAM}]=] [=[--gtest_filter=${suite}.*]=] --gtest_brief=1)\n"
        "set_tests_properties([=[${LABEL}.${suite}]=] PROPERTIES LABELS ${LABEL} TIMEOUT 1800)\n")
endforeach()
if(tests STREQUAL "")
    message(FATAL_ERROR "${PROGRAM}: lists no tests")
endif()
file(WRITE ${OUTPUT} "${tests}")
