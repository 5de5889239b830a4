"""Reproduction of the paper: run its cases, plot its figures, check its sentences, write a page."""
