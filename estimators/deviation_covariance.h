// The covariance of the deviation observer: what the periods since its last renewal make of it. Apart from the step,
// which comes in every period and runs from RAM; this comes in one of several.

#ifndef STILLSPIN_ESTIMATORS_DEVIATION_COVARIANCE_H
#define STILLSPIN_ESTIMATORS_DEVIATION_COVARIANCE_H

#include "estimators/deviation_observer.h"

#define DEVIATION_VARIANCE_BITS 29u  // 512, Q20
#define DEVIATION_VARIANCE_MAX ((int32_t)1 << DEVIATION_VARIANCE_BITS)

// How far the boost of the load's noise (noise_boost_q30) has faded when a step may be noticed again.
#define DEVIATION_BOOST_AGAIN_Q30 858993459L  // at a crawl, after 11 ms
#define DEVIATION_BOOST_OVER_Q30 53687091L    // at speed, after 150 ms: what is suspected for ever is the model

/// Predicts it over those periods, admits what the load may have done in them, more where a step of it is suspected,
/// and takes the information that was gathered.
void deviation_covariance_renew(deviation_observer_t* s, const deviation_observer_config_t* c, bool suspected);

#endif
