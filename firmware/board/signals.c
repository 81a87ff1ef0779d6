// Looks at the signals of the board's sensors.

#include "firmware/board/functions.h"

// Behind everything else: it has short names.
#include "firmware/drive/signal_looks.h"
// Behind that, of which its rows are made.
#include "firmware/board/signal_list.h"
