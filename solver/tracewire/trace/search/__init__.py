"""From the declared model to effects: refits in the loop, accepted on data no fit saw."""
