#include "firmware/interfaces/source.h"
#include "firmware/sources/sources.h"

// The flux's four methods are one source.
const position_source_t* const position_sources[] = {&encoder_source, &paper_source,    &observer_avv_source,
                                                     &avv_source,     &observer_source, &flux_source,
                                                     &flux_source,    &flux_source,     &flux_source};
