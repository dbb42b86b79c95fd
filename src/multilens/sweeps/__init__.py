"""Sweeps: many jobs of one question, each computed once, and the tables of what came of them."""
