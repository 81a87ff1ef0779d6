# The drive's sources as objects with a 16-bit int: toolchain/int16/compile.py.
file(GLOB_RECURSE drive_sources CONFIGURE_DEPENDS RELATIVE ${PROJECT_SOURCE_DIR}
  ${PROJECT_SOURCE_DIR}/hal/*.c ${PROJECT_SOURCE_DIR}/control/*.c ${PROJECT_SOURCE_DIR}/svpwm/*.c
  ${PROJECT_SOURCE_DIR}/estimators/*.c ${PROJECT_SOURCE_DIR}/firmware/*.c)
list(FILTER drive_sources EXCLUDE REGEX "/image/|/flash_kernel/|/lamp/|/flash\\.c$")  # other programs, and what only they use
file(GLOB_RECURSE drive_headers CONFIGURE_DEPENDS
  ${PROJECT_SOURCE_DIR}/hal/*.h ${PROJECT_SOURCE_DIR}/control/*.h ${PROJECT_SOURCE_DIR}/svpwm/*.h
  ${PROJECT_SOURCE_DIR}/estimators/*.h ${PROJECT_SOURCE_DIR}/firmware/*.h)

# Makes <folder>/all.o of some of them (SOURCES) and of a test's own (OWN).
function(stillspin_int16_objects folder)
  cmake_parse_arguments(ARG "" "" "SOURCES;OWN;OPTIONS" ${ARGN})
  set(sources ${ARG_SOURCES} ${ARG_OWN})
  list(TRANSFORM sources PREPEND ${PROJECT_SOURCE_DIR}/ OUTPUT_VARIABLE absolute_sources)
  add_custom_command(OUTPUT ${folder}/all.o
    COMMAND ${Python_EXECUTABLE} ${PROJECT_SOURCE_DIR}/toolchain/int16/compile.py ${folder} ${ARG_OPTIONS}
            --made ${made_folder} ${sources} ${composed_sources}
    WORKING_DIRECTORY ${PROJECT_SOURCE_DIR} VERBATIM
    DEPENDS ${absolute_sources} ${drive_headers} ${composed_sources}
            ${PROJECT_SOURCE_DIR}/toolchain/int16/compile.py ${PROJECT_SOURCE_DIR}/toolchain/int16/include/characters.h
            ${PROJECT_SOURCE_DIR}/toolchain/int16/include/stdint.h
    COMMENT "Compiling the drive with a 16-bit int")
  set_source_files_properties(${folder}/all.o PROPERTIES EXTERNAL_OBJECT ON GENERATED ON)
endfunction()
