/* The drive in the flash of a TMS320F2808. Blocks and their addresses: toolchain/f2808/memory.csv, which
   `make lint` compares with this file.

   Sector A is programmed once, over JTAG: boot entry, passwords, boot code, and the resident part, which refers to
   nothing outside of itself and has no globals, so that it comes out the same word for word, in every edition, as long
   as its sources and the compiler do. Sectors B to D hold the rest and are what an update erases; an update brings an
   image whose sector A is the board's. What does not fit B to D goes behind the resident part: such an image is whole,
   but no update can bring it. CSM_RESERVED and PASSWORDS take no section and no fill: they stay erased, all ones, which
   leaves the chip open. Passwords of all zeros would lock it for ever. */

--stack_size=0x400

MEMORY
{
PAGE 0:
  APP_ENTRY    : origin = 0x3E8000, length = 0x000020   /* sector D begins here */
  IDENTITY     : origin = 0x3E8020, length = 0x000020   /* in the same place in every image: the boot code looks */
  APP          : origin = 0x3E8040, length = 0x00BFB8   /* the rest of D, C, B, without its last 8 words, see below */
  BOOT         : origin = 0x3F4000, length = 0x000020   /* sector A begins here */
  RESIDENT     : origin = 0x3F4020, length = 0x003F58
  CSM_RESERVED : origin = 0x3F7F80, length = 0x000076
  ENTRY        : origin = 0x3F7FF6, length = 0x000002   /* where the boot ROM jumps to */
  PASSWORDS    : origin = 0x3F7FF8, length = 0x000008
  RAM_FIXED    : origin = 0x000010, length = 0x0003E8   /* M0; not at 0, which is no function's address */
  RAM_FIXED_H0 : origin = 0x3FA6A8, length = 0x000500   /* H0 behind RAM_DATA, by its high address */
  RAM_CODE     : origin = 0x3FABA8, length = 0x001450   /* the rest of it */
PAGE 1:
  STACK        : origin = 0x000400, length = 0x000400   /* M1: SP reaches the low 64 K only */
  RAM_DATA     : origin = 0x008000, length = 0x0026A8   /* L0, L1, some of H0 by its low address: one piece */
}

/* The CPU fetches ahead of what it runs: code keeps off the last eight words of a block of memory. Start-up zeroes
   .ebss by the two symbols below, so it has to stay in one piece. There is no heap: .esysmem is empty. The boot ROM
   has its own stack in 0x400 to 0x47F, and is through when the drive's begins. Resident is, one after the
   other, what every edition needs of the floors that know nothing of the drive, but for what looks at the windows, which
   is worked on most; octets and check sums of firmware/base; and of TI's library what that calls, but for 64-bit
   quotients, which commissioning alone wants.

   What runs from RAM has no wait states. ramfixed, ramfixedh0 and ramfuncs list what brings most cycles of an interrupt
   for a word (make isr-cost says what in RAM is cold, and what in flash is hotter than what is listed): objects of the
   resident part, which run from M0 and from a piece of H0 in every image, and functions of the rest. Of drivers that
   some images have compiled otherwise (stillspin_unrecorded) it is marked in the source, TARGET_RAM_CODE. */

SECTIONS
{
  codestart : > ENTRY,     PAGE = 0
  boot      : > BOOT,      PAGE = 0
  appentry  : > APP_ENTRY, PAGE = 0
  identity  : > IDENTITY,  PAGE = 0
  ramfixed  : { libstillspin_qmath.a<qtrig.*>(.text)
                libstillspin_svpwm.a<edges.*, windows.*>(.text)
                libstillspin_estimators.a<slopes.*>(.text)
              } LOAD = RESIDENT, RUN = RAM_FIXED, PAGE = 0,
              LOAD_START(_image_ram_fixed_load), RUN_START(_image_ram_fixed_run), SIZE(_image_ram_fixed_size)
  ramfixedh0: { libstillspin_qmath.a<qcall.*, qdiv.*>(.text)
                libstillspin_svpwm.a<alternating.*, modulator.*, ripple.*>(.text)
              } LOAD = RESIDENT, RUN = RAM_FIXED_H0, PAGE = 0,
              LOAD_START(_image_ram_fixed_h0_load), RUN_START(_image_ram_fixed_h0_run), SIZE(_image_ram_fixed_h0_size)
  ramfuncs  : { *(ramfuncs)
                libstillspin_hal.a<sampling_timer.*>(.text:_hal_sampling_timer_read, .text:_hal_sampling_timer_set_legs)
                libstillspin_firmware.a<control_interrupt.*>(.text:_drive_control_step, .text:_drive_control_interrupt)
                libstillspin_firmware.a<schedule.*>(.text:_schedule_next)
                libstillspin_firmware.a<sampling.*>(.text:_drive_read_samples, .text:_drive_window_interrupt)
                libstillspin_firmware.a<position.*>(.text:_drive_estimate)
                libstillspin_firmware.a<protection.*>(.text:_drive_protect)
                libstillspin_firmware.a<current.*>(.text:_drive_control_current)
                libstillspin_firmware.a<modulation.*>(.text:_modulate_into, .text:_write_frame)
                libstillspin_firmware.a<mode.*>(.text:_is_energised)
                libstillspin_firmware.a<observer.*>(.text:_source_observer)
                libstillspin_firmware.a<signals.*>(.text:_phase_current)
                libstillspin_firmware.a<scope.*>(.text:_scope_step)
                libstillspin_firmware.a<hysteresis.*>(.text:_hysteresis_slice)
                libstillspin_estimators.a<deviation_observer.*>(.text:_deviation_observer_step)
                libstillspin_estimators.a<regression.*>(.text:_regression_evaluate)
                libstillspin_estimators.a<deviation.*>(.text:_deviation_frames, .text:_deviation_model, .text:_deviation_see,
                                                       .text:_deviation_changes)
                libstillspin_qmath.a<qsum.*>(.text)
              } LOAD = APP, RUN = RAM_CODE, PAGE = 0,
              LOAD_START(_image_ram_code_load), RUN_START(_image_ram_code_run), SIZE(_image_ram_code_size)
  quotients : { rts2800_ml.lib<ll_div*>(.text) } > APP, PAGE = 0
  resident  : { rts2800_ml.lib<l_div*, u_div*, i_div*, ll_*, memcpy*, memset*>(.text)
                libstillspin_qmath.a<qcall.*>(.econst, .switch)
                libstillspin_qmath.a<qdiv.*>(.econst, .switch)
                libstillspin_qmath.a<qquotient.*>(.text, .econst, .switch)
                libstillspin_qmath.a<qsqrt.*>(.text, .econst, .switch)
                libstillspin_qmath.a<qtrig.*>(.econst, .switch)
                libstillspin_svpwm.a<alternating.*>(.econst, .switch)
                libstillspin_svpwm.a<dead_time.*>(.text, .econst, .switch)
                libstillspin_svpwm.a<edges.*>(.econst, .switch)
                libstillspin_svpwm.a<extended.*>(.text, .econst, .switch)
                libstillspin_svpwm.a<modulator.*>(.econst, .switch)
                libstillspin_svpwm.a<on_time.*>(.text, .econst, .switch)
                libstillspin_svpwm.a<ripple.*>(.econst, .switch)
                libstillspin_svpwm.a<windows.*>(.econst, .switch)
                libstillspin_control.a<brake_limit.*>(.text, .econst, .switch)
                libstillspin_control.a<current_controller.*>(.text, .econst, .switch)
                libstillspin_control.a<field_weakening.*>(.text, .econst, .switch)
                libstillspin_control.a<frame.*>(.text, .econst, .switch)
                libstillspin_control.a<machine_map.*>(.text, .econst, .switch)
                libstillspin_control.a<machine_model.*>(.text, .econst, .switch)
                libstillspin_control.a<mtpa.*>(.text, .econst, .switch)
                libstillspin_control.a<position_hold.*>(.text, .econst, .switch)
                libstillspin_control.a<rise.*>(.text, .econst, .switch)
                libstillspin_control.a<speed_controller.*>(.text, .econst, .switch)
                libstillspin_estimators.a<axis.*>(.text, .econst, .switch)
                libstillspin_estimators.a<blend.*>(.text, .econst, .switch)
                libstillspin_estimators.a<cogging.*>(.text, .econst, .switch)
                libstillspin_estimators.a<deviation_covariance.*>(.text, .econst, .switch)
                libstillspin_estimators.a<emf_sign.*>(.text, .econst, .switch)
                libstillspin_estimators.a<followed.*>(.text, .econst, .switch)
                libstillspin_estimators.a<inertia_match.*>(.text, .econst, .switch)
                libstillspin_estimators.a<inverse_inductance.*>(.text, .econst, .switch)
                libstillspin_estimators.a<polarity.*>(.text, .econst, .switch)
                libstillspin_estimators.a<saturation.*>(.text, .econst, .switch)
                libstillspin_estimators.a<slopes.*>(.econst, .switch)
                libstillspin_estimators.a<tracking_observer.*>(.text, .econst, .switch)
                libstillspin_estimators.a<voltage_match.*>(.text, .econst, .switch)
                libstillspin_estimators.a<wiring.*>(.text, .econst, .switch)
                libstillspin_firmware.a<crc.*>(.text, .econst, .switch)
                libstillspin_firmware.a<octets.*>(.text, .econst, .switch)
              } > RESIDENT, PAGE = 0
  .cinit    : > APP,       PAGE = 0
  .pinit    : > APP,       PAGE = 0
  .switch   : > APP,       PAGE = 0
  .text     : >> APP | RESIDENT, PAGE = 0
  .econst   : >> APP | RESIDENT, PAGE = 0
  .stack    : > STACK,     PAGE = 1
  .ebss     : > RAM_DATA,  PAGE = 1, RUN_START(_image_globals_start), SIZE(_image_globals_size)
  .esysmem  : > RAM_DATA,  PAGE = 1
}
