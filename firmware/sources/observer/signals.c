// Looks at the signals of what position sources have in common.

#include "firmware/sources/observer/observer.h"

// Behind everything else: it has short names.
#include "firmware/drive/signal_looks.h"
// Behind that, of which its rows are made.
#include "firmware/sources/observer/signal_list.h"
