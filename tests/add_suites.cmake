# Asks a test program for its suites and writes one CTest test for each: a process a suite, not one a test, so that
# what the tests of a suite share is computed once.
#   cmake -D PROGRAM=... -D LEVEL=... -D COST=... -D FILE=... -P add_suites.cmake
execute_process(COMMAND ${PROGRAM} --gtest_list_tests OUTPUT_VARIABLE listed RESULT_VARIABLE failed)
if(failed)
  message(FATAL_ERROR "${PROGRAM} cannot list its tests: ${failed}")
endif()
string(REGEX MATCHALL "(^|\n)[A-Za-z0-9_/]+\\.[ \t]*(#[^\n]*)?\n" suites "${listed}")
set(text "")
foreach(suite IN LISTS suites)
  string(REGEX MATCH "[A-Za-z0-9_/]+" suite "${suite}")
  # Ranks that are threads wake each other in every step, across processors at several times the cost.
  set(affinity "")
  if(LEVEL MATCHES "mpi|parity" AND NOT suite MATCHES "ProgramOnRanks|FateOfRank")
    set(affinity " PROCESSOR_AFFINITY ON")
  endif()
  set(cost ${COST})
  if(suite MATCHES "^(Program|FreeMesh|Extrinsic|FractureEnergy|CrackLine|Bedding|SphereOnFaces)$") # half a minute each
    set(cost 4)
  endif()
  string(APPEND text "add_test([==[${suite}]==] [==[${PROGRAM}]==] [==[--gtest_filter=${suite}.*]==] --gtest_brief=1)\n"
    "set_tests_properties([==[${suite}]==] PROPERTIES LABELS ${LEVEL} COST ${cost} TIMEOUT 900 ENVIRONMENT GOMP_SPINCOUNT=2000${affinity})\n")
endforeach()
if(text STREQUAL "")
  message(FATAL_ERROR "${PROGRAM} lists no tests")
endif()
file(WRITE ${FILE} "${text}")
