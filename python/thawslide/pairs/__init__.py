"""A case on cells of 4h, 2h and h: results with their errors, for `thawslide run --pair`."""
