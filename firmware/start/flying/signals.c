// Looks at the signals of the look for a turning shaft.

#include "firmware/api/status.h"

// Behind everything else: it has short names.
#include "firmware/drive/signal_looks.h"
// Behind that, of which its rows are made.
#include "firmware/start/flying/signal_list.h"
