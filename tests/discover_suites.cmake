# Read by ctest: registers every suite of a GoogleTest PROGRAM as one test. A process for each test would spend more time
# on loading its 116 libraries than most tests take, and would make anew what a suite makes once for all its tests.
function(plumbline_discover_suites program)
  execute_process(COMMAND ${program} --gtest_list_tests OUTPUT_VARIABLE listing RESULT_VARIABLE status)
  if(NOT status EQUAL 0)
    message(FATAL_ERROR "${program} does not list its tests: ${status}")
  endif()
  # A suite's line ends in a full stop (and maybe a comment); its tests follow, indented.
  string(REGEX MATCHALL "\n[A-Za-z][A-Za-z0-9_/]*\\." suites "\n${listing}")
  foreach(suite IN LISTS suites)
    string(REGEX REPLACE "[\n.]" "" suite "${suite}")
    add_test(${suite} ${program} --gtest_brief=1 --gtest_filter=${suite}.*)
    set_tests_properties(${suite} PROPERTIES TIMEOUT 600)
  endforeach()
endfunction()
