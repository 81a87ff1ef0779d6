// What runs beside the control interrupt, at background level.

#ifndef STILLSPIN_FIRMWARE_INTERFACES_SERVICE_H
#define STILLSPIN_FIRMWARE_INTERFACES_SERVICE_H

/// Puts it to where it is after power-on.
typedef void service_reset_t(void);
/// Those of the edition in their order, NULL behind the last one (editions/): the drive's own and the parameters are
/// reset before them.
extern service_reset_t* const edition_resets[];

#endif
