// Parameters that an interrupt uses as they stand: rows of a list, see interfaces/config_values.h.

CONFIG_VALUE(polarity_current)
CONFIG_VALUE(start_current)
