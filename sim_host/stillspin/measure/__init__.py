"""From a run's records to figures of merit."""
