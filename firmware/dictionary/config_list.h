// Parameters that an interrupt uses as they stand: rows of a list, see interfaces/config_values.h.

CONFIG_VALUE(current_limit)
CONFIG_VALUE(link_maximum)
CONFIG_VALUE(link_minimum)
CONFIG_VALUE(rated_current)
CONFIG_VALUE(speed_limit)
CONFIG_VALUE(trip_current)
