// Whether the parameters fit together.

#ifndef STILLSPIN_FIRMWARE_CONFIG_RULES_H
#define STILLSPIN_FIRMWARE_CONFIG_RULES_H

#include "firmware/dictionary/parameters.h"
#include "firmware/text/packed_text.h"

#if defined(__cplusplus)
extern "C" {
#endif

/// The rule of the drive's own that the present parameters break, one sentence; PACKED_NONE: none.
packed_text_t parameter_rule_broken(void);
/// Why the present parameters cannot be used together, one sentence; PACKED_NONE when they can, and the configuration
/// of them is made (config.h).
packed_text_t parameter_conflict(void);
/// The same, were this parameter at that value.
packed_text_t parameter_conflict_with(const parameter_info_t* p, int32_t raw);
/// The same of the present ones, without a calculation when the background level has made a configuration of them.
packed_text_t parameter_conflict_known(void);

#if defined(__cplusplus)
}
#endif

#endif
