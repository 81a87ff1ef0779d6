"""Studies, from their options to a folder of results: campaigns with what runs beside, what makes a figure."""
