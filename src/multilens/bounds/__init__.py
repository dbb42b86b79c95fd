"""Lower bounds: a number that no feasible layout scores below, with the proof in docs/bounds.md."""
