"""What a finished search says: errors, effects, ties, and the edited diagram."""
