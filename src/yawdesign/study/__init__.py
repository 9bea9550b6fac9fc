"""Many cases: sweeps and maps."""
