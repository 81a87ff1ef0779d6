// From one who knows angle and speed to the position sources and the speed control: no step in the torque.

#include "firmware/drive/brake_release_hold.h"
#include "firmware/drive/polarity_watch.h"
#include "firmware/drive/position.h"
#include "firmware/drive/steps.h"
#include "firmware/mode/mode.h"

void drive_bumpless_transfer(drive_t* d, uint32_t angle_bam, int32_t speed_bpp) {
  position_preset(d, &d->estimate, angle_bam, speed_bpp);
  speed_controller_preset(&d->control.speed, 0);
  hold_end();
  polarity_watch_begin(angle_bam, speed_bpp);
  d->control.ramp.value = speed_bpp;
}
