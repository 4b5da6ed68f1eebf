"""One linearisation along the fitted runs, and what it promises of every candidate."""
