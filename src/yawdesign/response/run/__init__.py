"""How the vehicle answers: frequencies, runs over a track, the damper in them."""
