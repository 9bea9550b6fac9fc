"""The bogie as an FMI 3 unit (FMU) for other simulation programs."""
