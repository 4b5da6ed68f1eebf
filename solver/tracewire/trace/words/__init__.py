"""What a trace found, in words."""
