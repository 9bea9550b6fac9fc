"""For other codes: a problem's functions as files."""
