"""What the wheelsets meet: tracks, spectra, measured files."""
