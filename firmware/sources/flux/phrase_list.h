// Why the flux's parameters do not fit: PHRASE(name, text), see text/phrase_list.h.

PHRASE(flux_high_must_be_above_flux_low, "flux_high must be above flux_low")
PHRASE(flux_beside_needs_position_source_0, "flux_beside needs position_source 0")
