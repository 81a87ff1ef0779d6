// What falls on which period: nothing long beside anything else that is long.
//
// While the shaft turns, each of the ten periods of a millisecond has a task beside what every period does:
//
//   0  speed control            5  field weakening
//   1  synchronism, cogging     6  synchronism, inertia
//   2  slot                     7  slot
//   3  covariance               8  covariance
//   4  slot                     9  slot
//
// The slot goes round among what may wait (schedule_slot_t). Its five places have no factor in common with its four
// periods, and two of these are even and two odd: as the alternating layout repeats after six periods, the regression
// sees every direction of the voltage alike.
//
// Some things cannot wait: an operating point that the torque current has left, and a covariance whose gain gets old or
// that a load has just changed. A slot gives way to one of them, three times in a row at most. A shaft that is held
// against a brake that opens learns nothing meanwhile: its operating point has every slot, and one judgement besides.
// Before the shaft turns every period is a slot that has no task of its own. A decision of the start has a period for
// itself, an exclusive slot: nothing else is done, and the estimator leaves its windows out. So does the observer
// beside the flux in the periods of speed control and field weakening.

#ifndef STILLSPIN_FIRMWARE_INTERFACES_SCHEDULE_H
#define STILLSPIN_FIRMWARE_INTERFACES_SCHEDULE_H

#include <stdbool.h>
#include <stdint.h>

typedef enum {
  SLOT_REGRESSION = 0,  // the windows on their voltages; of fewer than three the watch looks at the back-EMF, too
  SLOT_LOOK = 1,        // is that near enough to learn from? The model's K, or the polarity's watch follows the axis
  SLOT_INDUCTANCE = 2,  // inverse inductances and match of the sensors
  SLOT_VOLTAGE = 3,     // resistance and flux, before the drive runs the sensors; with three windows the watch looks
  SLOT_OPERATING_POINT = 4,  // the model moves to the operating point
  SCHEDULE_SLOTS = 5         // and none of them
} schedule_slot_t;

typedef enum { TASK_SPEED, TASK_FIELD, TASK_JUDGE_FIRST, TASK_JUDGE, TASK_RENEW, TASK_SLOT } task_t;

typedef struct {
  uint16_t period;       // of the millisecond
  task_t task;           // of the period while the shaft turns
  bool turning;          // the shaft does in this period
  bool held;             // against what a brake that opens lets fall on it
  schedule_slot_t slot;  // whose slot this period is, SCHEDULE_SLOTS for nobody's
  uint16_t last;         // who had it last
  uint16_t waited;       // slots that have given way since then
  bool moved_last;       // of what cannot wait, it was the operating point
  bool moves;          // the model follows the operating point in this period, the deviation observer its sensitivities
  bool renews;         // the deviation observer renews its covariance
  bool judges;         // the synchronism is judged
  bool unsure;         // the deviation observer does not know the angle yet
  bool update_urgent;  // its next windows may make it renew the covariance, asked or not: so in its first millisecond
  bool exclusive;      // the start has this period for a decision
  bool skips;          // there is no room for the windows: the estimators leave them out
} schedule_t;

#endif
