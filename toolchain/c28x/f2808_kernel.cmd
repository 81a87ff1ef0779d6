/* The flash kernel in the RAM of a TMS320F2808, loaded by the boot ROM's serial loader. H0 holds its code, by the high
   address, and behind that its data, by the low one: H0 is not secured, so that the kernel can say that a chip is
   locked. The boot ROM works in 0x400 to 0x47F while it loads; the stack is M0. Blocks: toolchain/f2808/memory.csv. */

--stack_size=0x3C0

MEMORY
{
PAGE 0:
  IDENTITY     : origin = 0x3FA000, length = 0x000020   /* a host looks at the first word */
  CODE         : origin = 0x3FA020, length = 0x0017E0
PAGE 1:
  STACK        : origin = 0x000000, length = 0x000400   /* M0 */
  RAM_SPARE    : origin = 0x000480, length = 0x000378   /* M1 */
  RAM_DATA     : origin = 0x00B800, length = 0x0007F8   /* H0 behind the code */
}

/* Nothing is zeroed: the kernel sets what it uses. All of it runs from RAM, TI's flash library, too. */

SECTIONS
{
  identity  : > IDENTITY,  PAGE = 0
  .text     : > CODE,      PAGE = 0
  .cinit    : > CODE,      PAGE = 0
  .pinit    : > CODE,      PAGE = 0
  .switch   : > CODE,      PAGE = 0
  .econst   : > CODE,      PAGE = 0
  ramfuncs  : > CODE,      PAGE = 0
  .stack    : > STACK,     PAGE = 1
  .ebss     : > RAM_DATA,  PAGE = 1
  .esysmem  : > RAM_SPARE, PAGE = 1
}
