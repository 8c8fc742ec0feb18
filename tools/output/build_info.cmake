# Run at every build, for what a result says it came from: at configure time the commit would be an older one.
# cmake -D SOURCE_DIR=... -D TEMPLATE=... -D OUTPUT=... -D PROJECT_VERSION=... -P build_info.cmake
execute_process(COMMAND git describe --always --abbrev=12 --exclude=* --dirty WORKING_DIRECTORY ${SOURCE_DIR}
  OUTPUT_VARIABLE PLUMBLINE_GIT_COMMIT OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
configure_file(${TEMPLATE} ${OUTPUT} @ONLY)  # touched only by a change
