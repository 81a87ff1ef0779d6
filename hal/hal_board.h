// The board in use. cmake -DSTILLSPIN_BOARD=name puts another one of hal/boards/ in the place of this file.

#ifndef STILLSPIN_HAL_HAL_BOARD_H
#define STILLSPIN_HAL_HAL_BOARD_H

#include "hal/boards/bench.h"

#endif
