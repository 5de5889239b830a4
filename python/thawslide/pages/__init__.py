"""HTML pages of runs: parts of a page, interactive views, comparison of runs, and two-page summary."""
