"""How the bogie moves: track, frequency response, motion in time."""
