// Parameters that an interrupt uses as they stand: rows of a list, see interfaces/config_values.h.

CONFIG_VALUE(bootstrap_time)
CONFIG_VALUE(emergency_stop)
CONFIG_VALUE(overload_current)
CONFIG_VALUE(overload_time)
CONFIG_VALUE(precharge_voltage)
