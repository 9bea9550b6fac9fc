"""Many points at once: the same questions as for a single bogie, on arrays."""
