include("${CMAKE_CURRENT_LIST_DIR}/breccia-targets.cmake")
