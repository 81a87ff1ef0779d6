// How signals are looked at. For who includes a signal_list.h next, and nothing else behind it: each of its rows
// becomes the function look_at_NAME, which the table of the edition names.

#include "firmware/dictionary/units.h"
#include "firmware/drive/steps.h"
#include "hal/qmath/qcall.h"

#define PLACE(number)

#define DRIVE 0
#define ROTOR KNOWN_ROTOR
#define FRAME KNOWN_FRAME
#define HEAT_SINK KNOWN_HEAT_SINK
#define ASKED FRAME  // and known to be 0 else, see the table

// Volatile: to the background level the interrupt changes the drive at any time.
#define SIGNAL_RPM(speed_bpp) qc_mul_sat(speed_bpp, d->config.rpm_per_bpp_q40, 24)

// What is known is asked once for all of a pass: it has to fit between two interrupts.
#define SIGNAL(name, unit, q, of, value, meaning)                     \
  signal_look_t look_at_##name;                                       \
  int32_t look_at_##name(const volatile drive_t* d, uint16_t known) { \
    (void)d;                                                          \
    return (((of) & ~(int32_t)known) != 0) ? 0 : (int32_t)(value);    \
  }
