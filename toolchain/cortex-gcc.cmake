# GCC for a Cortex-M in QEMU, which speaks to this computer by semihosting; used by `cmake --preset cortex-m3` and
# `cortex-m4`, which set STILLSPIN_CORE.

set(CMAKE_SYSTEM_NAME Generic)
set(CMAKE_SYSTEM_PROCESSOR cortex)
set(CMAKE_C_COMPILER arm-none-eabi-gcc)
list(APPEND CMAKE_TRY_COMPILE_PLATFORM_VARIABLES STILLSPIN_CORE)
set(CMAKE_C_FLAGS_INIT "-mcpu=${STILLSPIN_CORE} -mthumb --specs=rdimon.specs")
