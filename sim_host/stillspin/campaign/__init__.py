"""Monte Carlo over what differs from unit to unit: what is drawn, how a case is judged, what it is shrunk to."""
