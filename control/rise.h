// A straight line between two ends.

#ifndef STILLSPIN_CONTROL_RISE_H
#define STILLSPIN_CONTROL_RISE_H

#include <stdint.h>

#define RISE_ONE_Q30 1073741824L

/// 0 where x is `from` or less, 1 where it is `to` or more, in proportion between them, Q30, to 2^-28. from < to; x and
/// `to` are less than 2^31 above `from`.
int32_t rise_q30(int32_t x, int32_t from, int32_t to);

#endif
