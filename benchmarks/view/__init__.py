"""How fast the live page follows: from a slider to the painted curve, in a real browser."""
