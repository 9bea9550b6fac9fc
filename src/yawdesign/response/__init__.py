"""How the bogie moves on a track: frequency responses, time histories, and what its yaw damper has to do."""
