"""What would have been seen, and which experiment would decide."""
