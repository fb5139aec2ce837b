# cmake -DPROGRAM=... -DLABEL=... -DOUTPUT=... -P ListSuites.cmake: writes what ctest includes, one test for each suite of
# a GoogleTest program. The tests of a suite share a process, since a driver compiles pipelines anew in each: for most
# tests of pictures that takes longer than the pictures do. Suites of more tests are begun first (COST), or one would be
# left to run alone.
execute_process(COMMAND ${PROGRAM} --gtest_list_tests OUTPUT_VARIABLE listed COMMAND_ERROR_IS_FATAL ANY)
string(REGEX MATCHALL "[^\n]+" lines "${listed}")
set(suite "")
set(suites "")
foreach(line IN LISTS lines)
    if(line MATCHES "^([A-Za-z0-9_/]+)[.]")
        set(suite ${CMAKE_MATCH_1})
        list(APPEND suites ${suite})
        set(count_${suite} 0)
    elseif(suite AND line MATCHES "^  ")
        math(EXPR count_${suite} "${count_${suite}} + 1")
    endif()
endforeach()
set(tests "")
foreach(suite IN LISTS suites)
    string(APPEND tests "add_test([=[${LABEL}.${suite}]=] [=[${PROGRAM}]=] [=[--gtest_filter=${suite}.*]=] --gtest_brief=1)\n"
        "set_tests_properties([=[${LABEL}.${suite}]=] PROPERTIES LABELS ${LABEL} TIMEOUT 1800 COST ${count_${suite}})\n")
endforeach()
if(tests STREQUAL "")
    message(FATAL_ERROR "${PROGRAM}: lists no tests")
endif()
file(WRITE ${OUTPUT} "${tests}")
