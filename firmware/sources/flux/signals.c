// Looks at the signals of the stator-flux sources.

#include "firmware/sources/flux/flux.h"

// Behind everything else: it has short names.
#include "firmware/drive/signal_looks.h"
// Behind that, of which its rows are made.
#include "firmware/sources/flux/signal_list.h"
