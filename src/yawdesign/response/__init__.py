"""How it moves: modes and what becomes of them, answers to the track, motion in time."""
