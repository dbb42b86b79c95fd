"""The benchmark: the search against what a designer would use instead, on problems fixed before any result was seen."""
