# Installs the estimator alone to a fresh prefix, and builds and runs a program against it as a robot's own code would:
# with find_package(plumbline), and with no simulator on its link line.
# -D BUILD=… the build tree, -D SOURCE=… the program's sources, -D SCRATCH=… a folder to work in
file(REMOVE_RECURSE ${SCRATCH})
execute_process(COMMAND ${CMAKE_COMMAND} --install ${BUILD} --prefix ${SCRATCH}/prefix --component estimator
  OUTPUT_QUIET COMMAND_ERROR_IS_FATAL ANY)
execute_process(COMMAND ${CMAKE_COMMAND} -S ${SOURCE} -B ${SCRATCH}/build -G "Unix Makefiles"
  -DCMAKE_BUILD_TYPE=Release -DCMAKE_PREFIX_PATH=${SCRATCH}/prefix "-DCMAKE_EXE_LINKER_FLAGS=${LINK_FLAGS}"
  OUTPUT_QUIET COMMAND_ERROR_IS_FATAL ANY)
execute_process(COMMAND ${CMAKE_COMMAND} --build ${SCRATCH}/build OUTPUT_QUIET COMMAND_ERROR_IS_FATAL ANY)
file(READ ${SCRATCH}/build/CMakeFiles/consumer.dir/link.txt link_line)
foreach(simulator mujoco embree OSMesa yaml-cpp)
  if(link_line MATCHES ${simulator})
    message(FATAL_ERROR "${simulator} is on the link line: ${link_line}")
  endif()
endforeach()
execute_process(COMMAND ${SCRATCH}/build/consumer COMMAND_ERROR_IS_FATAL ANY)
