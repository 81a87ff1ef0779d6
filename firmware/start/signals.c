// Looks at the signals of the start.

#include "firmware/start/step.h"

// Behind everything else: it has short names.
#include "firmware/drive/signal_looks.h"
// Behind that, of which its rows are made.
#include "firmware/start/signal_list.h"
