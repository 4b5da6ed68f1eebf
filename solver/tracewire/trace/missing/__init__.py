"""Where something is missing and what it depends on, whatever its name."""
