"""Measurements: `python -m bench NAME [--smoke]` prints one JSON line per figure."""
