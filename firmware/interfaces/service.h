// What features have done beside the control law: lists of functions, gone through in their order, with NULL behind the
// last one (editions/).

#ifndef STILLSPIN_FIRMWARE_INTERFACES_SERVICE_H
#define STILLSPIN_FIRMWARE_INTERFACES_SERVICE_H

#include <stdint.h>

struct drive;

typedef void service_t(void);

/// To where they are after power-on, behind the drive and the parameters: with every reset of the drive.
extern service_t* const edition_resets[];

/// The same of what a reset of the drive leaves alone: once, before anything of the board is set up.
extern service_t* const edition_power_on[];

/// Again and again while the converter comes up, once at least.
extern service_t* const edition_loading[];

/// The board is set up, the interrupts are to come.
extern service_t* const edition_starting[];

/// In every pass of the background loop. Nothing waits there; what is the drive's own rests while a host steps it
/// (api/status.h).
extern service_t* const edition_pass[];

/// What the background level works out for the drive between two control interrupts, from the drive alone: a recording
/// has it (hal/hal_replay.h), and a host that steps the drive has it done between two steps.
typedef void work_t(const struct drive* d);
extern work_t* const edition_works[];

/// Before the watchdog is serviced, so many CPU cycles after the last time; NULL where nobody counts.
typedef void watch_t(uint32_t cycles);
extern watch_t* const edition_watch;

#endif
