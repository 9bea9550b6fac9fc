"""A problem's functions as files for other codes."""
