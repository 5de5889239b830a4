"""Forecasts: members of sweep.toml, their prior check against published events, maps and summary."""
