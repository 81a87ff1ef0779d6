#include "firmware/api/status.h"

feature_status_t feature_status;
