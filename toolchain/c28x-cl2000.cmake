# TI's C2000 code generation tools (cl2000, 18.12 LTS or newer) for the F2808; used by `cmake --preset f2808`.
#
# C2000_CG_ROOT, in the environment or by -D, is the folder that has bin/cl2000, include and lib; without it cl2000 is
# looked for in the PATH. COFF, because TI's flash library for this chip is COFF and the two do not link together.

set(CMAKE_SYSTEM_NAME Generic)
set(CMAKE_SYSTEM_PROCESSOR c28x)
set(CMAKE_TRY_COMPILE_TARGET_TYPE STATIC_LIBRARY)  # a program would need the linker command file
list(APPEND CMAKE_TRY_COMPILE_PLATFORM_VARIABLES C2000_CG_ROOT)

if(NOT C2000_CG_ROOT)
  set(C2000_CG_ROOT "$ENV{C2000_CG_ROOT}" CACHE PATH "Folder of TI's C2000 code generation tools")
endif()
find_program(C2000_COMPILER cl2000 HINTS "${C2000_CG_ROOT}/bin" NO_CMAKE_FIND_ROOT_PATH)
if(NOT C2000_COMPILER)
  message(FATAL_ERROR
    "TI's compiler cl2000 is not there, and nothing else makes code for the F2808.\n"
    "Install the C2000 code generation tools (C2000-CGT, free of charge from TI), then\n"
    "  C2000_CG_ROOT=/folder/of/ti-cgt-c2000 cmake --preset f2808\n"
    "Everything but the image builds and is tested without it: make test. What that proves: docs/evidence.md")
endif()
get_filename_component(C2000_BIN "${C2000_COMPILER}" DIRECTORY)
get_filename_component(C2000_TOOLS "${C2000_BIN}" DIRECTORY)

set(CMAKE_C_COMPILER "${C2000_COMPILER}")
set(CMAKE_ASM_COMPILER "${C2000_COMPILER}")
set(CMAKE_AR "${C2000_BIN}/ar2000" CACHE FILEPATH "TI's archiver")
# -v28 -ml: C28x, 22-bit addresses. softlib: this chip has no floating-point unit. The prefetch advisory of SPRZ171 is
# about fast branches in flash: they are neither made nor overlooked.
set(C2000_FLAGS "-v28 -ml --float_support=softlib --abi=coffabi --no_fast_branch --flash_prefetch_warn")
set(CMAKE_ASM_FLAGS_INIT "${C2000_FLAGS}")
# -O2 --opt_for_speed=0: the flash is what is short; what an interrupt runs has 1 (stillspin_timed). --relaxed_ansi: asm, __cregister, __interrupt.
set(CMAKE_C_FLAGS_INIT
  "${C2000_FLAGS} --relaxed_ansi -O2 --opt_for_speed=0 --gen_func_subsections=on --display_error_number --emit_warnings_as_errors -I\"${C2000_TOOLS}/include\"")
set(CMAKE_C_FLAGS_RELEASE_INIT "")
# 10068, no matching section: the linker command file lists what an object may have, such as tables of switches.
set(CMAKE_EXE_LINKER_FLAGS_INIT
  "--rom_model --warn_sections --diag_remark=10068 --reread_libs -i\"${C2000_TOOLS}/lib\" -lrts2800_ml.lib")
