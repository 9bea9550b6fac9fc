"""Yaw damper design for motor bogies."""
