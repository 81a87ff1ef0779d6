/* The drive in the flash of a TMS320F2808. Blocks and their addresses: toolchain/f2808/memory.csv, which
   `make lint` compares with this file.

   Sector A keeps the boot entry and the passwords and is programmed once, over JTAG; sectors B to D hold the drive and
   are what an update erases. What of code and constants does not fit there goes behind the boot code: such an image is
   whole, but no update can bring it. CSM_RESERVED and PASSWORDS take no section and no fill: they stay erased, all ones, which
   leaves the chip open. Passwords of all zeros would lock it for ever. */

--stack_size=0x7F8

MEMORY
{
PAGE 0:
  APP_ENTRY    : origin = 0x3E8000, length = 0x000020   /* sector D begins here */
  IDENTITY     : origin = 0x3E8020, length = 0x000020   /* in the same place in every image: the boot code looks */
  APP          : origin = 0x3E8040, length = 0x00BFB8   /* the rest of D, C, B, without its last 8 words, see below */
  BOOT         : origin = 0x3F4000, length = 0x003F78   /* sector A */
  CSM_RESERVED : origin = 0x3F7F80, length = 0x000076
  ENTRY        : origin = 0x3F7FF6, length = 0x000002   /* where the boot ROM jumps to */
  PASSWORDS    : origin = 0x3F7FF8, length = 0x000008
  RAM_CODE     : origin = 0x3FB000, length = 0x000FF8   /* upper half of H0, by its high address */
PAGE 1:
  STACK        : origin = 0x000000, length = 0x0007F8   /* M0, M1: SP reaches the low 64 K only */
  RAM_DATA     : origin = 0x008000, length = 0x003000   /* L0, L1, lower half of H0 by its low address: one piece */
}

/* The CPU fetches ahead of what it runs: code keeps off the last eight words of a block of memory. Start-up zeroes
   .ebss by the two symbols below, so it has to stay in one piece. There is no heap: .esysmem is empty. The boot ROM
   has its own stack in 0x400 to 0x47F, and is through when the drive's begins. */

SECTIONS
{
  codestart : > ENTRY,     PAGE = 0
  boot      : > BOOT,      PAGE = 0
  appentry  : > APP_ENTRY, PAGE = 0
  identity  : > IDENTITY,  PAGE = 0
  .cinit    : > APP,       PAGE = 0
  .pinit    : > APP,       PAGE = 0
  .switch   : > APP,       PAGE = 0
  ramfuncs  : LOAD = APP, RUN = RAM_CODE, PAGE = 0,
              LOAD_START(_image_ram_code_load), RUN_START(_image_ram_code_run), SIZE(_image_ram_code_size)
  .text     : >> APP | BOOT, PAGE = 0
  .econst   : >> APP | BOOT, PAGE = 0
  .stack    : > STACK,     PAGE = 1
  .ebss     : > RAM_DATA,  PAGE = 1, RUN_START(_image_globals_start), SIZE(_image_globals_size)
  .esysmem  : > RAM_DATA,  PAGE = 1
}
