/* A program in the RAM of a TMS320F2808, loaded over JTAG or by the boot ROM's serial loader: the lamp (firmware/lamp),
   and parts of the drive for tests on the bench. The whole drive does not fit. Nothing is placed below 0x480, where the
   boot ROM works while it loads, except the stack and the entry. Blocks: toolchain/f2808/memory.csv. */

--stack_size=0x3C0

MEMORY
{
PAGE 0:
  ENTRY        : origin = 0x000000, length = 0x000002   /* where the boot ROM jumps to, mode pins 010 */
  APP_ENTRY    : origin = 0x008000, length = 0x000020
  IDENTITY     : origin = 0x008020, length = 0x000020
  APP          : origin = 0x3FA000, length = 0x001FF8   /* H0 */
PAGE 1:
  STACK        : origin = 0x000002, length = 0x0003FE   /* M0 */
  RAM_SPARE    : origin = 0x000480, length = 0x000378   /* M1 */
  RAM_DATA     : origin = 0x008040, length = 0x001FB8   /* L0, L1 */
}

SECTIONS
{
  codestart : > ENTRY,     PAGE = 0
  boot      : > APP,       PAGE = 0
  appentry  : > APP_ENTRY, PAGE = 0
  identity  : > IDENTITY,  PAGE = 0
  .text     : > APP,       PAGE = 0
  .cinit    : > APP,       PAGE = 0
  .pinit    : > APP,       PAGE = 0
  .switch   : > APP,       PAGE = 0
  .econst   : > APP,       PAGE = 0
  ramfuncs  : > APP,       PAGE = 0, LOAD_START(_image_ram_code_load), RUN_START(_image_ram_code_run),
              SIZE(_image_ram_code_size)
  .stack    : > STACK,     PAGE = 1
  .ebss     : > RAM_DATA,  PAGE = 1, RUN_START(_image_globals_start), SIZE(_image_globals_size)
  .esysmem  : > RAM_SPARE, PAGE = 1
}
