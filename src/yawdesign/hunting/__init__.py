"""Is it stable: Routh, Hurwitz, modes, critical damping."""
