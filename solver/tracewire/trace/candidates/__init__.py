"""What is tried: effects of the library at the places of a diagram."""
