"""Results for people: pages, drawings, tables, progress."""
