#include "torque_limit.h"

// Behind everything else: it has short names.
#include "firmware/drive/signal_looks.h"
#include "signal_list.h"
